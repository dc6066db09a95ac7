#include "study/report/plots/figures.h"
#include "study/report/plots/series_plot.h"

#include <algorithm>
#include <map>
#include <set>

namespace touchstone::study {

namespace {

constexpr const char* kRayFloor = "one Embree ray, the floor";
constexpr const char* kTriangles = "triangles";
constexpr const char* kTime = "time per tick in contact, µs (median; bar: 95 % interval)";

SeriesPoint timeOf(const ConfigurationResult& r) {
    return {static_cast<double>(r.triangles), 1e-3 * r.step.value, 1e-3 * r.step.low, 1e-3 * r.step.high};
}

/// The median of the floors over the configurations of a scene.
void addFloors(SeriesPlot& plot, const std::vector<const ConfigurationResult*>& configurations) {
    std::map<std::pair<std::string, size_t>, std::vector<double>> floors;
    for (const ConfigurationResult* r : configurations)
        if (r->rayFloor > 0.0)
            floors[{r->shape, r->triangles}].push_back(1e-3 * r->rayFloor);
    std::map<std::string, Series> byShape;
    for (auto& [where, values] : floors) {
        std::sort(values.begin(), values.end());
        const double middle = values[values.size() / 2];
        Series& series = byShape[where.first];
        series.colourName = kRayFloor;
        series.markName = where.first;
        series.floor = true;
        series.points.push_back({static_cast<double>(where.second), middle, middle, middle});
    }
    for (auto& [shape, series] : byShape)
        plot.series.push_back(std::move(series));
}

/// Configurations of the tessellation ablation, of shapes that have more than one.
std::vector<const ConfigurationResult*> tessellated(const StudyResult& result) {
    std::map<std::string, std::set<size_t>> sizes;
    for (const ConfigurationResult& r : result.configurations)
        if (r.ablation == kTessellationAblation)
            sizes[r.shape].insert(r.triangles);
    std::vector<const ConfigurationResult*> configurations;
    for (const ConfigurationResult& r : result.configurations)
        if (r.ablation == kTessellationAblation && sizes[r.shape].size() > 1 && r.step.value > 0.0)
            configurations.push_back(&r);
    return configurations;
}

Figure ofShapes(const StudyResult& result) {
    const std::vector<const ConfigurationResult*> configurations = tessellated(result);
    SeriesPlot plot;
    plot.name = "cost_over_triangles";
    plot.paper.title = "Time per tick over the number of triangles";
    plot.paper.subtitle = "The same shapes cut finer and finer. Flat curves are what one hopes for.";
    plot.xWords = kTriangles;
    plot.yWords = kTime;
    plot.colourTitle = "configuration";
    plot.markTitle = "shape";
    std::map<std::pair<std::string, std::string>, size_t> at;
    for (const ConfigurationResult* r : configurations) {
        const auto [place, fresh] = at.try_emplace({r->shape, r->configuration}, plot.series.size());
        if (fresh)
            plot.series.push_back({r->configuration, r->shape, {}});
        plot.series[place->second].points.push_back(timeOf(*r));
    }
    addFloors(plot, configurations);
    return figureOf(std::move(plot), result.provenance);
}

/// The default configuration of the largest ablation; null where there is none.
const ConfigurationResult* defaultOf(const SceneRungs& scene) {
    std::map<std::string, size_t> sizes;
    for (const ConfigurationResult* r : scene.configurations)
        ++sizes[r->ablation];
    const ConfigurationResult* found = nullptr;
    for (const ConfigurationResult* r : scene.configurations)
        if (r->isDefault && r->step.value > 0.0 && r->triangles > 0 &&
            (found == nullptr || sizes[r->ablation] > sizes[found->ablation]))
            found = r;
    return found;
}

/// The default configuration on each scene, one point per scene.
Figure ofScenes(const StudyResult& result) {
    std::vector<const ConfigurationResult*> configurations;
    for (const SceneRungs& scene : byScene(result, false))
        if (const ConfigurationResult* r = defaultOf(scene))
            configurations.push_back(r);
    if (configurations.size() < 2)
        return {};
    SeriesPlot plot;
    plot.name = "cost_of_scenes";
    plot.paper.title = "Time per tick of each scene, as the program touches it by itself";
    plot.paper.subtitle = "Over the number of triangles.";
    plot.xWords = kTriangles;
    plot.yWords = kTime;
    plot.colourTitle = "scene";
    constexpr size_t kMaxNames = 24;
    for (const ConfigurationResult* r : configurations)
        plot.series.push_back({configurations.size() <= kMaxNames ? r->scene : "a scene",
                               configurations.size() <= kMaxNames ? r->scene : "a scene",
                               {timeOf(*r)}});
    Series floor{kRayFloor, kRayFloor, {}, true};
    for (const ConfigurationResult* r : configurations)
        if (r->rayFloor > 0.0)
            floor.points.push_back({static_cast<double>(r->triangles), 1e-3 * r->rayFloor, 1e-3 * r->rayFloor,
                                    1e-3 * r->rayFloor});
    plot.series.push_back(std::move(floor));
    return figureOf(std::move(plot), result.provenance);
}

} // namespace

std::vector<Figure> costOverTriangles(const StudyResult& result) {
    std::vector<Figure> figures{ofShapes(result), ofScenes(result)};
    std::erase_if(figures, [](const Figure& f) { return f.name.empty(); });
    return figures;
}

} // namespace touchstone::study
