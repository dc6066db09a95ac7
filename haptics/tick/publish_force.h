#pragma once
// The force that a hand's touch gives out. A part of haptic_step.cpp alone.

#include "haptics/force/spring_damper.h"
#include "haptics/tick/object_step.h"

namespace touchstone {

/// The force, in the workspace, as much of it as the device bears. Pushes the objects that are touched.
/// `travel`: m, of the hand since the preceding tick.
inline void publishForce(const HandTick& tick, const Similarity& workspaceFromReference, const Felt& felt,
                         const glm::dvec3& travel, WorldState& world, HapticOutput& output) {
    if (tick.limits.press < INFINITY) [[unlikely]]
        output.borne = yieldingShare(felt.share * felt.force, tick.limits.press);
    const double share = felt.share * output.borne;
    output.force = workspaceFromReference.direction(felt.force);
    if (share < 1.0)
        output.force *= share;
    if (tick.parts != nullptr && felt.object >= 0) [[unlikely]] {
        const double born = bornByDevice(tick, felt, share);
        pushObjects(workspaceFromReference, felt.force, born,
                    {.velocity = travel / tick.dt,
                     .stiffness = share * felt.stiffness,
                     .most = tick.limits.maxForce,
                     .wanted = born > 0.0 ? share / born : 1.0},
                    *tick.parts, world);
    }
}

} // namespace touchstone
