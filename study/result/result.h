#pragma once
// Results of a study: plain data, between measurement (study/…) and report (study/report).

#include "haptics/tick/stopwatch.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::study {

/// A figure and its 95 % confidence interval.
struct Estimate {
    double value = 0.0, low = 0.0, high = 0.0;
    bool operator==(const Estimate&) const = default;
};

/// Differences from the truth over the ticks of a path. Lengths in m, forces in N, angles in rad, of the
/// workspace. The maximum is kept beside median and 99th percentile, since rare errors are felt too.
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
    double largestJump = 0.0;         ///< maximum change of force in one tick, N
    double truthJump = 0.0;           ///< the same of the truth on the same path, N
    double energyCreated = 0.0;       ///< J, gained by the hand beyond the truth's on the same path
    double contactLost = 0.0;         ///< fraction of the truth's contact ticks without contact here
    double contactInvented = 0.0;     ///< fraction of the truth's free ticks with contact here
    uint64_t ticks = 0, compared = 0; ///< run; in contact in both
    uint64_t truthFailed = 0;         ///< ticks in which the oracle did not converge: not compared
    bool operator==(const Errors&) const = default;
};

/// The reference of the errors: the smooth shape in closed form; the mesh itself, in long double; the
/// ablation's most exact configuration, where an effect has no other truth; Coulomb's law on the frictionless
/// result.
enum class Truth : uint8_t { Analytic, Oracle, Reference, Coulomb };

/// The scalar error that orders configurations (Pareto fronts), N.
[[nodiscard]] inline double felt(const Errors& errors) {
    return errors.force.p99;
}

/// One configuration on one scene and path.
struct ConfigurationResult {
    std::string scene;    ///< "torus 64,800", "WaterBottle.glb"
    std::string shape;    ///< the analytic shape, or the file's name without the tessellation: groups scenes
    size_t triangles = 0; ///< of the scene
    double facetAngle =
        0.0;              ///< rad, mean angle between adjacent facets under the path; 0: not a tessellation
    std::string path;     ///< "stroke 1 mm, 0.1 m/s"
    std::string ablation; ///< "contact", "shading", …, "combination"; see study/ablation
    std::string configuration; ///< "sweep r = 0.5 mm"
    std::string settings;      ///< "contact=sweep proxyRadius=0.0005": the --set arguments that select it
    double rateHz = 1000.0;
    Truth truth = Truth::Oracle;
    bool isDefault = false; ///< the program's default

    Estimate step;        ///< ns, median of the step over contact ticks, clock overhead subtracted
    Estimate stepMean;    ///< ns, mean of the same
    double stepP99 = 0.0; ///< ns
    /// ns, mean of each stage over the same ticks, clock overhead subtracted; by Stage.
    std::array<Estimate, kStageCount> stages;
    double rayFloor = 0.0; ///< ns, median of one Embree ray from proxy to HIP in the same ticks
    Errors errors;
    bool pareto = false; ///< on the Pareto front of this scene, path and ablation (study/pareto.h)
    bool operator==(const ConfigurationResult&) const = default;
};

/// Closed-loop stability over the servo rate.
struct RateResult {
    double rateHz = 0.0;
    double stiffestStable = 0.0; ///< N/m, wall, measured
    double bound = 0.0;          ///< N/m, from theory (source in docs/closed_loop.md)
    double energyCreated = 0.0;  ///< J in a stroke over the scene at the default stiffness
    Estimate busy;               ///< fraction of one processor that the steps take
    bool operator==(const RateResult&) const = default;
};

/// VoxelResult::source.
inline constexpr const char *kFromClosedForm = "closed form", *kFromMesh = "mesh";

/// A shape felt as a distance field of one voxel size, or, to compare with, as its mesh.
struct VoxelResult {
    std::string shape;    ///< "torus"
    std::string source;   ///< of the nodes: kFromClosedForm or kFromMesh
    std::string method;   ///< "sweep", "virtual point, tricubic", …; "mesh" where no field is touched
    size_t triangles = 0; ///< of the source, or of the mesh that is touched
    double across = 0.0;  ///< voxels on the diagonal of the shape's box; 0: no field
    double voxel = 0.0;   ///< m
    double memory = 0.0;  ///< bytes, of the field
    double build = 0.0;   ///< s, of the field
    /// Proxy from the truth's over the ticks in which both touch, m. The truth of nodes out of the closed
    /// form is the closed form; that of nodes out of a mesh is the proxy on the mesh.
    double meanPosition = 0.0;
    Spread position;
    double meanSurface = 0.0, maxSurface = 0.0; ///< m, proxy from the closed form's surface, over the same
    Spread direction;                           ///< rad, force from the truth's
    double contactLost = 0.0;                   ///< fraction of the truth's contact ticks
    Estimate step;                              ///< ns, median over contact ticks
    double stepP99 = 0.0;                       ///< ns
    double rayFloor = 0.0;                      ///< ns, of an Embree ray; 0 on a field
    bool operator==(const VoxelResult&) const = default;
};

/// A just-noticeable difference and its source.
struct JustNoticeable {
    std::string quantity, unit, source;
    double value = 0.0;
    bool operator==(const JustNoticeable&) const = default;
};

/// Where and how it was measured.
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
    std::vector<VoxelResult> voxels;
    std::vector<std::string> problems; ///< models that could not be studied: file and reason
    std::vector<std::string>
        notes; ///< configurations left out because they make no difference there, and similar remarks
    bool operator==(const StudyResult&) const = default;
};

} // namespace touchstone::study
