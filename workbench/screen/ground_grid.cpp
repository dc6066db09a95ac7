#include "workbench/screen/ground_grid.h"

#include "workbench/figures/quantity.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kCells = 10.0; // about so many along the model's longest side
// Of that side, on every side of the model: with a spacing more it stays within the model's diagonal, which
// the near plane of a perspective leaves room for (OrbitCamera::nearPlane).
constexpr double kBeyond = 0.28;
constexpr double kBeneath = 1e-3; // of that side: below what lies on the ground

/// The largest of 1, 2 and 5 times a power of ten up to `size`.
double roundSpacing(double size) {
    const double decade = std::pow(10.0, std::floor(std::log10(size)));
    for (const double step : {5.0, 2.0})
        if (step * decade <= size)
            return step * decade;
    return decade;
}

} // namespace

GroundGrid::GroundGrid(const Bounds& scene) {
    if (scene.empty())
        return;
    const glm::dvec3 extent = scene.extent();
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (!(longest > 0.0) || !std::isfinite(longest))
        return;
    spacing = roundSpacing(longest / kCells);
    const auto outwards = [&](double low, double high) {
        return glm::dvec2(std::floor((low - kBeyond * longest) / spacing) * spacing,
                          std::ceil((high + kBeyond * longest) / spacing) * spacing);
    };
    const glm::dvec2 x = outwards(scene.low.x, scene.high.x), z = outwards(scene.low.z, scene.high.z);
    const double y = scene.low.y - kBeneath * longest;
    bounds.include({x[0], y, z[0]});
    bounds.include({x[1], y, z[1]});
}

void GroundGrid::draw(const Similarity& workspaceFromScene, float pixelScale, Overlay& overlay) const {
    if (!(spacing > 0.0))
        return;
    constexpr glm::vec4 kPlain(0.55f, 0.58f, 0.62f, 0.22f), kTenth(0.6f, 0.63f, 0.68f, 0.5f),
        kAlongX(0.75f, 0.12f, 0.14f, 0.85f), kAlongZ(0.12f, 0.3f, 0.85f, 0.85f);
    constexpr int kBright = 10;
    const auto lines = [&](glm::length_t across, glm::length_t along, const glm::vec4& axis) {
        const auto first = std::llround(bounds.low[across] / spacing),
                   last = std::llround(bounds.high[across] / spacing);
        for (auto i = first; i <= last; ++i) {
            glm::dvec3 from = bounds.low, to = bounds.low;
            from[across] = to[across] = static_cast<double>(i) * spacing;
            to[along] = bounds.high[along];
            overlay.grid.push_back({.from = workspaceFromScene.point(from),
                                    .to = workspaceFromScene.point(to),
                                    .color = i == 0             ? axis
                                             : i % kBright == 0 ? kTenth
                                                                : kPlain,
                                    .width = (i == 0 ? 1.6f : 1.1f) * pixelScale});
        }
    };
    lines(2, 0, kAlongX); // the line z = 0 runs along x
    lines(0, 2, kAlongZ);
}

std::string GroundGrid::label() const {
    return "grid " + quantity(spacing, shownUnit(spacing, "m"));
}

} // namespace touchstone
