#pragma once
// Stage 4 without a second pass: turns the force of one contact to its interpolated normal.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/solve/solve_result.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Direction of a contact's force. Reference frame.
struct TurnedNormal {
    glm::dvec3 normal{0.0}; ///< unit
    double cosine = 1.0;    ///< distance along `normal` = distance from the facet / cosine
};

/// `normal` itself where the contact's material does not turn it. Morgenbesser (`direction`) keeps the
/// magnitude and turns the force to the interpolated normal; Ho (`projected`) takes the distance of the HIP
/// from the facet along it [000 §4.1].
[[nodiscard]] TurnedNormal turnedNormal(const HapticScene& scene, ObjectMotions motions,
                                        const HapticSettings& settings, int reference, const Contact& contact,
                                        const glm::dvec3& normal) noexcept;

} // namespace touchstone
