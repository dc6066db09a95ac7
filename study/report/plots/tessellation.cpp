#include "study/report/plots/figures.h"
#include "study/report/plots/series_plot.h"

#include <map>
#include <numbers>
#include <set>

namespace touchstone::study {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::string_view kFacetAngle = "facet angle";

/// From "facet angle, no shading", "[004 Table 2], …, force only (C1)": "C1 0.5°" and "no shading".
Threshold thresholdOf(const JustNoticeable& j) {
    const size_t comma = j.quantity.find(", ");
    const size_t open = j.source.rfind('('), close = j.source.rfind(')');
    const bool named = open != std::string::npos && close != std::string::npos && close - open == 3;
    return {kDegrees * j.value,
            (named ? j.source.substr(open + 1, 2) + " " : "") + brief(kDegrees * j.value) + "°",
            comma == std::string::npos ? j.quantity : j.quantity.substr(comma + 2)};
}

} // namespace

std::vector<Figure> errorOverTessellation(const StudyResult& result) {
    SeriesPlot plot;
    plot.name = "error_over_tessellation";
    plot.paper.title = "How far the force points aside, over how coarsely a shape is cut";
    plot.paper.subtitle = "Error against the smooth shape. Left of a dashed line people feel a smooth curve.";
    plot.paper.area.left = 112.0;
    plot.paper.area.top = 622.0;
    plot.thresholdTitle = "just noticeable facet angle, [004 Table 2]";
    plot.xWords = "angle between adjacent facets under the path, degrees (mean)";
    plot.yWords = "error of the force's direction, degrees (99 % of ticks are nearer)";
    plot.colourTitle = "configuration";
    plot.markTitle = "shape";
    plot.minY = 1e-5;
    plot.leastText = "below 0.00001°";
    std::map<std::pair<std::string, std::string>, size_t> at;
    std::set<double> angles;
    for (const ConfigurationResult& r : result.configurations) {
        if (r.ablation != kTessellationAblation || !(r.facetAngle > 0.0) || r.errors.compared == 0)
            continue;
        const auto [place, fresh] = at.try_emplace({r.shape, r.configuration}, plot.series.size());
        if (fresh)
            plot.series.push_back({r.configuration, r.shape, {}});
        const double error = kDegrees * r.errors.forceDirection.p99;
        plot.series[place->second].points.push_back({kDegrees * r.facetAngle, error, error, error});
        angles.insert(r.facetAngle);
    }
    if (angles.size() < 2)
        return {};
    for (const JustNoticeable& j : result.noticeable)
        if (j.quantity.starts_with(kFacetAngle) && j.value > 0.0)
            plot.thresholds.push_back(thresholdOf(j));
    return {figureOf(std::move(plot), result.provenance)};
}

} // namespace touchstone::study
