#include "haptics/texture/spot_maps.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

const SurfaceGradients& SpotMaps::gradients(int set) noexcept {
    const auto s = static_cast<size_t>(set & 1);
    if (!known_[s]) {
        gradients_[s] = smoothed(spot_, spot_.object.uvGradients[s], [&]() -> SurfaceGradients {
            const glm::dvec2 a = spot_.uvAt(set, 0), b = spot_.uvAt(set, 1), c = spot_.uvAt(set, 2);
            return {gradientOver(spot_.triangle, a.x, b.x, c.x), gradientOver(spot_.triangle, a.y, b.y, c.y)};
        });
        known_[s] = true;
    }
    return gradients_[s];
}

void SpotMaps::settle(const HapticMap& map) noexcept {
    if (settled_ == &map.layout())
        return;
    settled_ = &map.layout();
    printed_ = false;
    place_ = map.transform(spot_.uv[map.layout().texCoord & 1 ? 1 : 0]);
    const SurfaceGradients& uv = gradients(map.layout().texCoord);
    const glm::dmat2& j = map.layout().jacobian;
    over_ = {j[0][0] * uv.first + j[1][0] * uv.second, j[0][1] * uv.first + j[1][1] * uv.second};
    if (filter_ != TextureFilter::Mip)
        return;
    const glm::dvec2 size(map.layout().width, map.layout().height);
    const double texelsPerObject =
        std::sqrt(std::max(size.x * size.x * glm::dot(over_.first, over_.first),
                           size.y * size.y * glm::dot(over_.second, over_.second)));
    const double texels = 2.0 * stroke_ / spot_.workspacePerObject * texelsPerObject;
    level_ = texels > 1.0 ? std::log2(texels) : 0.0;
}

const HapticMap::Footprint& SpotMaps::footprint(const HapticMap& map) noexcept {
    settle(map);
    if (!printed_)
        map.footprint(place_, level_, footprint_);
    printed_ = true;
    return footprint_;
}

const HapticMap::Patch& SpotMaps::patch(const HapticMap& map) noexcept {
    settle(map);
    if (!printed_)
        map.patch(place_, filter_, patch_);
    printed_ = true;
    return patch_;
}

} // namespace touchstone
