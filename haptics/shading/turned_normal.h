#pragma once
// Stage 4 without a second pass: the force of one contact turned to its interpolated normal.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/solve/solve_result.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Which way a contact pushes. Reference frame.
struct TurnedNormal {
    glm::dvec3 normal{0.0}; ///< unit
    double cosine = 1.0;    ///< the distance from the facet, over this, is the distance along `normal`
};

/// `normal` where the contact's material does not turn it. Morgenbesser (`direction`) keeps the magnitude and
/// turns the force to the interpolated normal; Ho (`projected`) takes the distance of the HIP from the facet
/// along it [000 §4.1].
[[nodiscard]] TurnedNormal turnedNormal(const HapticScene& scene, ObjectMotions motions,
                                        const HapticSettings& settings, int reference, const Contact& contact,
                                        const glm::dvec3& normal) noexcept;

} // namespace touchstone
