#pragma once
// Options that several commands have. All throw CLI::ValidationError while a command line is parsed that says
// something impossible; what they fill outlives the parsing.

#include "workbench/options/commands.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <string_view>

namespace touchstone {

/// Ends of helps: every setting, every figure of the simulated device and hand, every stroke, the exit
/// status.
[[nodiscard]] std::string settingsHelp();
[[nodiscard]] std::string plantHelp();
[[nodiscard]] std::string strokesHelp();
inline constexpr const char* kExitHelp =
    "Exit status: 0 done, 1 bad input or a missing facility, 2 wrong usage.\n";

/// --size WxH, pixels.
void addSize(CLI::App& app, glm::ivec2& size, const std::string& meaning);
/// An option NAME=VALUE that may be given again; `assign` returns what is wrong.
CLI::Option* addAssignments(CLI::App& app, const std::string& option, const std::string& meaning,
                            std::function<std::string(std::string_view, std::string_view)> assign);
/// --set, that may be given again.
void addSettings(CLI::App& app, std::function<std::string(std::string_view, std::string_view)> assign);
void addSettings(CLI::App& app, HapticSettings& settings);
/// --plant, --stroke with its speed and depth, --workspace-scale, --rate, --gpu, --record with its fellows,
/// SCENE.
CLI::Option* addPlant(CLI::App& app, PlantParameters& plant);
CLI::Option* addStroke(CLI::App& app, StrokeRequest& stroke, const std::string& meaning);
void addZoom(CLI::App& app, double& zoom);
void addRate(CLI::App& app, double& rate, const std::string& meaning);
void addGpu(CLI::App& app, std::string& gpu);
void addEnvironment(CLI::App& app, std::filesystem::path& file);
void addRecording(CLI::App& app, RecordingOptions& options);
CLI::Option* addScene(CLI::App& app, std::filesystem::path& scene);
/// --device; `builtIn`: what may be named besides devices.
void addDevice(CLI::App& app, const std::string& builtIn,
               const std::function<void(const std::string&)>& take);

} // namespace touchstone
