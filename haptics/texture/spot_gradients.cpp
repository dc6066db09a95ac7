#include "haptics/texture/spot_gradients.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

SurfaceGradients smoothed(const SurfaceSpot& spot, const std::vector<GradientPair>& vertices,
                          const SurfaceGradients& facet) noexcept {
    if (!spot.smooth || vertices.empty())
        return facet;
    SurfaceGradients sum;
    for (size_t k = 0; k < 3; ++k) {
        const GradientPair& at = vertices[spot.source(k)];
        const bool known = std::isfinite(at[0].x);
        const double weight = spot.weight[static_cast<int>(k)];
        sum.first += weight * (known ? glm::dvec3(at[0]) : facet.first);
        sum.second += weight * (known ? glm::dvec3(at[1]) : facet.second);
    }
    return sum;
}

const SurfaceGradients& SpotGradients::uv(int set) noexcept {
    const auto s = static_cast<size_t>(set & 1);
    if (!known_[s]) {
        const glm::dvec2 a = spot_.uvAt(set, 0), b = spot_.uvAt(set, 1), c = spot_.uvAt(set, 2);
        uv_[s] = smoothed(
            spot_, spot_.object.uvGradients[s],
            {gradientOver(spot_.triangle, a.x, b.x, c.x), gradientOver(spot_.triangle, a.y, b.y, c.y)});
        known_[s] = true;
    }
    return uv_[s];
}

SurfaceGradients SpotGradients::map(const HapticMap& map) noexcept {
    const SurfaceGradients& over = uv(map.texCoord());
    const glm::dmat2& j = map.transformJacobian();
    return {j[0][0] * over.first + j[1][0] * over.second, j[0][1] * over.first + j[1][1] * over.second};
}

double SpotGradients::strokeLevel(const HapticMap& map, double stroke) noexcept {
    if (!(stroke > 0.0) || !spot_.hasUv(map.texCoord()))
        return 0.0;
    const SurfaceGradients g = this->map(map);
    const double texelsPerObject =
        std::max(map.size().x * glm::length(g.first), map.size().y * glm::length(g.second));
    const double texels = 2.0 * stroke / spot_.workspacePerObject * texelsPerObject;
    return texels > 1.0 ? std::log2(texels) : 0.0;
}

} // namespace touchstone
