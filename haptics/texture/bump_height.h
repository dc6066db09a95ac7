#pragma once
// The entry of the bump map, for texture=blinnMagnitude.

#include "haptics/settings/haptic_settings.h"
#include "haptics/texture/spot_maps.h"

namespace touchstone {

/// B [001 §4.3.2]: the displacement of the mesh that its height map or its vertex heights say, on the side
/// that is touched, workspace m, of either sign. 0 where there is neither.
[[nodiscard]] double readBumpEntry(const SurfaceSpot& spot, SpotMaps& maps,
                                   const HapticSettings& settings) noexcept;

} // namespace touchstone
