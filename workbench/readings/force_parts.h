#pragma once
// What a tick's force is made of, for display.

#include "haptics/servo/servo_loop.h"

namespace touchstone {

/// Unit normal of the mesh under the proxy, workspace: the mean of the active constraint planes, which are
/// the true facets whatever shading and texture make of them. So the force along it is what the bare mesh
/// would push with, and the force across it is what friction, texture and shading add. The felt normal where
/// no plane is active; zero without contact, and for a recorded tick that was not computed again.
[[nodiscard]] glm::dvec3 surfaceNormal(const HapticOutput& tick);

/// N, in components of the workspace and of the surface; zeros without contact.
struct ForceParts {
    double normal = 0.0;     ///< along surfaceNormal, > 0 away from the surface
    double tangential = 0.0; ///< magnitude of the rest, >= 0
};
[[nodiscard]] ForceParts forceParts(const HapticOutput& tick);

/// False where the force of `tick` is computed but the command to the device is zero: the force is switched
/// off, or safety holds it off after a fault. `settings`: of the tick.
[[nodiscard]] bool forceSent(const HapticOutput& tick, const HapticSettings& settings);

} // namespace touchstone
