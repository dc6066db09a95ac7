#include "haptics/texture/bump_height.h"

namespace touchstone {

double readBumpEntry(const SurfaceSpot& spot, SpotMaps& maps, const HapticSettings& settings) noexcept {
    const HapticMap& map = spot.material.height;
    double bump = 0.0; // model metres
    if (!map.empty() && spot.material.heightScale != 0.0 && spot.hasUv(map.layout().texCoord))
        bump = spot.material.heightScale * (maps.slope(map, spot.slopes).value - spot.material.heightMid);
    else
        bump = spot.attribute(spot.object.heights, 0.0);
    return (spot.backside ? -bump : bump) * settings.textureStrength * spot.workspacePerObject /
           spot.modelPerObject;
}

} // namespace touchstone
