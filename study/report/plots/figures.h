#pragma once
// The plots of a study, each a self-contained page.

#include "study/report/plots/figure.h"

namespace touchstone::study {

/// For each scene and path and for force, position and direction: error over time per tick of every
/// configuration, by ablation, with the ablation's Pareto front and the just-noticeable differences.
[[nodiscard]] std::vector<Figure> errorOverTime(const StudyResult& result);

/// For each scene and path: the mean tick of each configuration by stage.
[[nodiscard]] std::vector<Figure> costByStage(const StudyResult& result);

/// For each shape with several tessellations: time per tick over the number of triangles, with the time of an
/// Embree ray as the floor; for several scenes, the same of the default configuration on each.
[[nodiscard]] std::vector<Figure> costOverTriangles(const StudyResult& result);

/// Error of the force's direction over the angle between facets, with the angles at which a curve feels
/// smooth.
[[nodiscard]] std::vector<Figure> errorOverTessellation(const StudyResult& result);

/// The stiffest stable wall over the servo rate, with theory and processor load.
[[nodiscard]] std::vector<Figure> stabilityOverRate(const StudyResult& result);

/// Distance of the proxy from the truth's over the voxel of a distance field.
[[nodiscard]] std::vector<Figure> errorOverVoxel(const StudyResult& result);

/// Configurations of one scene and path, in the study's order.
struct SceneRungs {
    std::string scene, path;
    std::vector<const ConfigurationResult*> configurations;
    std::string file; ///< a name for file names, unique among the scenes
};
/// `tessellations`: includes scenes with the tessellation ablation only.
[[nodiscard]] std::vector<SceneRungs> byScene(const StudyResult& result, bool tessellations);

inline constexpr std::string_view kTessellationAblation = "tessellation";

} // namespace touchstone::study
