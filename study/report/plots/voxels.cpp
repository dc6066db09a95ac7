#include "study/report/plots/figures.h"
#include "study/report/plots/series_plot.h"

#include <map>
#include <set>

namespace touchstone::study {

std::vector<Figure> errorOverVoxel(const StudyResult& result) {
    SeriesPlot plot;
    plot.name = "error_over_voxel";
    plot.paper.title = "How far the proxy is from where it should be, over the voxel of the field";
    plot.paper.subtitle =
        "Nodes out of the closed form; a stroke 1 mm deep on sphere and torus, over an edge of the box and "
        "along the groove.";
    plot.xWords = "voxel, mm";
    plot.yWords = "proxy from the closed form's, µm (mean)";
    plot.colourTitle = "how the field is touched";
    plot.markTitle = "shape";
    plot.minY = 1e-4;
    plot.leastText = "below 0.0001 µm";
    std::map<std::pair<std::string, std::string>, size_t> at;
    std::set<double> voxels;
    for (const VoxelResult& v : result.voxels) {
        if (!(v.across > 0.0) || v.source != kFromClosedForm)
            continue;
        const auto [place, fresh] = at.try_emplace({v.shape, v.method}, plot.series.size());
        if (fresh)
            plot.series.push_back({v.method, v.shape, {}});
        const double error = 1e6 * v.meanPosition;
        plot.series[place->second].points.push_back({1e3 * v.voxel, error, error, error});
        voxels.insert(v.voxel);
    }
    if (voxels.size() < 2)
        return {};
    return {figureOf(std::move(plot), result.provenance)};
}

} // namespace touchstone::study
