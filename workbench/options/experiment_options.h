#pragma once
// touchstone experiment

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace touchstone {

/// touchstone experiment [STUDY] --out DIR, one of its modes.
struct ExperimentOptions {
    std::filesystem::path study; ///< empty: that of [004]
    std::filesystem::path out;   ///< the sessions' folder
    bool printStudy = false;     ///< the study as JSON, to begin one's own from
    bool observer = false;       ///< simulated people
    bool report = false;         ///< of the sessions in `out`
    uint64_t seed = 1;
    int people = 12; ///< simulated
    std::string attention = "everything";
    bool pilots = false;
    std::string commandLine; ///< as typed
    // The window:
    int person = 0;                     ///< from 1; 0: no window
    std::string device{};               ///< openDevice's choice; empty: the mouse
    double rateHz = 1000.0;             ///< of the servo
    bool noise = true;                  ///< white noise while something is felt
    glm::ivec2 size{1280, 800};         ///< screen coordinates
    std::string gpu{};                  ///< part of a Vulkan device's name
    std::filesystem::path statusJson{}; ///< written after each picture if given, for scripts and tests
};
void defineExperiment(CLI::App& app, ExperimentOptions& options);
/// Status 1 where a session or plot is missing from a report.
int experimentCommand(const ExperimentOptions& options);

} // namespace touchstone
