#pragma once
// The displaced surface at the contact: its bump height and normal, from maps or vertex heights.

#include "haptics/settings/haptic_settings.h"
#include "haptics/texture/spot_maps.h"

#include <glm/glm.hpp>

namespace touchstone {

struct Bump {
    glm::dvec3 normal{0.0}; ///< m: unit, object frame, outer side, tilt compressed
    double height = 0.0; ///< H >= 0 above the lowest place, seen from the side that is touched, workspace m
    bool hasHeight = false; ///< a height map or vertex heights define H
    bool tiltCompressed = false;
};

/// Bump of the material's maps and the mesh's vertex heights at the spot. With texture=law the normal map
/// supplies m where there is one; else the heights do: m = normalize(n - grad H + (grad H . n) n) [000], with
/// texture=blinn Blinn's bump normal [001 4.11].
[[nodiscard]] Bump readBump(const SurfaceSpot& spot, SpotMaps& maps, const HapticSettings& settings) noexcept;

} // namespace touchstone
