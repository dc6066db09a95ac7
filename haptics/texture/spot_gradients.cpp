#include "haptics/texture/spot_gradients.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

const SurfaceGradients& SpotGradients::uv(int set) noexcept {
    const auto s = static_cast<size_t>(set & 1);
    if (!known_[s]) {
        uv_[s] = smoothed(spot_, spot_.object.uvGradients[s], [&]() -> SurfaceGradients {
            const glm::dvec2 a = spot_.uvAt(set, 0), b = spot_.uvAt(set, 1), c = spot_.uvAt(set, 2);
            return {gradientOver(spot_.triangle, a.x, b.x, c.x), gradientOver(spot_.triangle, a.y, b.y, c.y)};
        });
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
    const Laid laid{map.texCoord(), map.size(), map.transformJacobian(), stroke};
    if (laid == laid_)
        return level_;
    laid_ = laid;
    const SurfaceGradients g = this->map(map);
    const glm::dvec2 size = map.size();
    const double texelsPerObject = std::sqrt(std::max(size.x * size.x * glm::dot(g.first, g.first),
                                                      size.y * size.y * glm::dot(g.second, g.second)));
    const double texels = 2.0 * stroke / spot_.workspacePerObject * texelsPerObject;
    return level_ = texels > 1.0 ? std::log2(texels) : 0.0;
}

} // namespace touchstone
