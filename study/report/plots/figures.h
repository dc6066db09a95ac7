#pragma once
// The pictures of a study, each a page that must be understood without any other.

#include "study/report/plots/figure.h"

namespace touchstone::study {

/// For each scene and path and for force, place and direction: error over time per tick of every
/// configuration, by ablation, with the ablation's Pareto front and what people just notice.
[[nodiscard]] std::vector<Figure> errorOverTime(const StudyResult& result);

/// For each scene and path: the mean tick of each configuration by stage.
[[nodiscard]] std::vector<Figure> costByStage(const StudyResult& result);

/// For each shape that was cut into different numbers of triangles: time per tick over their number beside
/// Embree's floor; where there are several scenes, the same of what the program does by itself on each.
[[nodiscard]] std::vector<Figure> costOverTriangles(const StudyResult& result);

/// Difference of the force's direction over the angle between facets, beside the angles at which a curve
/// feels smooth.
[[nodiscard]] std::vector<Figure> errorOverTessellation(const StudyResult& result);

/// The stiffest stable wall over the servo's rate, beside theory, and what of a processor that takes.
[[nodiscard]] std::vector<Figure> stabilityOverRate(const StudyResult& result);

/// Configurations of one scene and path, in the study's order.
struct SceneRungs {
    std::string scene, path;
    std::vector<const ConfigurationResult*> configurations;
    std::string file; ///< a name for it in names of files, of no other scene
};
/// `tessellations`: also scenes on which nothing but tessellation was studied.
[[nodiscard]] std::vector<SceneRungs> byScene(const StudyResult& result, bool tessellations);

inline constexpr std::string_view kTessellationAblation = "tessellation";

} // namespace touchstone::study
