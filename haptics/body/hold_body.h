#pragma once
// A hand that holds a body: a spring and a damper between the HIP and the place that it took hold of. What
// the body meets is felt through them.

#include "engine/device_io/device_io.h"
#include "engine/math/object_motion.h"
#include "haptics/body/body_world.h"
#include "haptics/state/grasp.h"

#include <glm/glm.hpp>

namespace touchstone::body {

/// True where the body of a haptic object can be held: it exists and something can push it.
[[nodiscard]] bool canHold(const BodyWorld& bodies, int object) noexcept;

/// The pull of one tick; workspace.
struct Hold {
    glm::dvec3 place{0.0}; ///< where the hand has hold of the body
    glm::dvec3 force{0.0}; ///< N, on the hand
};

/// Pulls the held body towards the hand, by no more than the device can exert, and turns it back to the
/// orientation in which it was taken, as a hand does that does not let it swing. The opposite of what the
/// body gets is `force`. `stiffness` of the contact, N/m; `velocity` of the HIP, m/s. The damper is that of a
/// mass on the spring at 0.7 of the critical damping, at most a fifth of what would stop the body in a step
/// and at most 5 N s/m, which the hand can bear.
[[nodiscard]] Hold holdBody(BodyWorld& bodies, ObjectMotions motions, const Grasp& grasp,
                            const glm::dvec3& hip, const glm::dvec3& velocity, double stiffness,
                            const DeviceLimits& limits, double dt) noexcept;

} // namespace touchstone::body
