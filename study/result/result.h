#pragma once
// What a study measured: plain data, between those who measure (study/…) and those who report (study/report).

#include "haptics/tick/stopwatch.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::study {

/// A figure and the interval that holds it with 95 % confidence.
struct Estimate {
    double value = 0.0, low = 0.0, high = 0.0;
    bool operator==(const Estimate&) const = default;
};

/// Differences from the truth over the ticks of a path. Lengths in m, forces in N, angles in rad, of the
/// workspace. Maximum beside median and 99th percentile: what is rare is felt too.
struct Spread {
    double median = 0.0, p99 = 0.0, max = 0.0;
    bool operator==(const Spread&) const = default;
};

struct Errors {
    Spread position;       ///< proxy from the truth's proxy, m
    Spread forceMagnitude; ///< | |F| - |F_truth| |, N
    Spread forceDirection; ///< angle between them where both are in contact, rad
    Spread
        force; ///< |F - F_truth| where either is in contact, N: magnitude, direction and lost contact in one
    double largestJump = 0.0;         ///< most change of force in one tick, N
    double truthJump = 0.0;           ///< the same of the truth on the same path, N
    double energyCreated = 0.0;       ///< J, given to the hand beyond what the truth gives on the same path
    double contactLost = 0.0;         ///< share of the truth's ticks in contact without contact here
    double contactInvented = 0.0;     ///< share of ticks in contact here of the truth's ticks without
    uint64_t ticks = 0, compared = 0; ///< lived; in contact in both
    uint64_t truthFailed = 0;         ///< ticks for which the oracle found no rest: not compared
    bool operator==(const Errors&) const = default;
};

/// What the errors are against: the smooth shape in closed form; the mesh itself, in long double; the
/// ablation's most exact configuration, where an effect has no other truth; Coulomb's law on what is felt
/// without friction.
enum class Truth : uint8_t { Analytic, Oracle, Reference, Coulomb };

/// By what a configuration is nearer the truth than another (Pareto fronts), N.
[[nodiscard]] inline double felt(const Errors& errors) {
    return errors.force.p99;
}

/// One configuration on one scene and path.
struct ConfigurationResult {
    std::string scene;    ///< "torus 64,800", "WaterBottle.glb"
    std::string shape;    ///< the analytic shape or the file's name without the tessellation: groups scenes
    size_t triangles = 0; ///< of the scene
    double facetAngle =
        0.0;              ///< rad, mean angle between adjacent facets under the path; 0: not a tessellation
    std::string path;     ///< "stroke 1 mm, 0.1 m/s"
    std::string ablation; ///< "contact", "shading", …, "combination"; see study/ablation
    std::string configuration; ///< "sweep r = 0.5 mm"
    std::string settings;      ///< "contact=sweep proxyRadius=0.0005": what --set takes to get it
    double rateHz = 1000.0;
    Truth truth = Truth::Oracle;
    bool isDefault = false; ///< what the program does by itself

    Estimate step;        ///< ns, median of the step over ticks in contact, clock's cost taken off
    Estimate stepMean;    ///< ns, mean of the same
    double stepP99 = 0.0; ///< ns
    /// ns, mean of each stage over the same ticks, clock's cost taken off; by Stage.
    std::array<Estimate, kStageCount> stages;
    double rayFloor = 0.0; ///< ns, median of one Embree ray from proxy to HIP in the same ticks
    Errors errors;
    bool pareto =
        false; ///< no other configuration of this scene, path and ablation beats it (study/pareto.h)
    bool operator==(const ConfigurationResult&) const = default;
};

/// Closed-loop stability over the servo rate.
struct RateResult {
    double rateHz = 0.0;
    double stiffestStable = 0.0; ///< N/m, wall, measured
    double bound = 0.0;          ///< N/m, from theory (source in docs/closed_loop.md)
    double energyCreated = 0.0;  ///< J in a stroke over the scene at the default stiffness
    Estimate busy;               ///< share of one processor that the steps take
    bool operator==(const RateResult&) const = default;
};

/// A difference that people just notice, and who measured it.
struct JustNoticeable {
    std::string quantity, unit, source;
    double value = 0.0;
    bool operator==(const JustNoticeable&) const = default;
};

/// Where and with what it was measured.
struct Provenance {
    std::string machine, processor, kernel, compiler, buildType, commit, date, command;
    unsigned processors = 0;
    bool operator==(const Provenance&) const = default;
};

struct StudyResult {
    Provenance provenance;
    std::vector<JustNoticeable> noticeable;
    std::vector<ConfigurationResult> configurations;
    std::vector<RateResult> rates;
    std::vector<std::string> problems; ///< models that could not be studied: file and reason
    std::vector<std::string>
        notes; ///< configurations left out because they make no difference there, and such
    bool operator==(const StudyResult&) const = default;
};

} // namespace touchstone::study
