#pragma once
// What the tick of a hand does to objects: it pushes them, takes hold of bodies and lets them go, and takes
// solids away. A part of haptic_step.cpp alone. Out of line: code that a scene may not need must not
// take registers from code that it needs.

#include "haptics/tick/felt_force.h"

namespace touchstone {

/// The forces on the objects that the hand touches are the opposite of those on the hand. A force that is not
/// finite ends at the hand's safety stage. `hand`: its velocity, stiffness and most; `share` of the force is
/// exerted.
[[gnu::noinline]] void pushObjects(const Similarity& workspaceFromReference, const glm::dvec3& force,
                                   double share, body::HandPush hand, ContactForces& parts,
                                   WorldState& world);

/// The fraction of a contact's force with which the hand pushes: no more than its device can exert.
inline double bornByDevice(const HandTick& tick, const Felt& felt, double share) {
    const double force = share * glm::length(felt.force);
    return force > tick.limits.maxForce ? share * tick.limits.maxForce / force : share;
}

/// Stage 7 of a hand that takes a solid away: its resistance joins the force.
[[gnu::noinline]] void resistTool(const HandTick& tick, const LiveTool& tool, const DeviceState& state,
                                  WorldState& world, HapticOutput& output);

/// Stages 2 to 7 of a hand that holds a body, and its release: then touch begins again where the hand is
/// clear of the model. False where it holds none.
[[gnu::noinline]] bool hold(const HandTick& tick, const DeviceSample& sample, bool sampled, WorldState& world,
                            DeviceState& state, HapticOutput& output);

/// The end of stage 7: a hand that may take hold of what it has just touched.
[[gnu::noinline]] void takeHold(const HandTick& tick, const DeviceSample& sample, const WorldState& world,
                                DeviceState& state, const HapticOutput& output);

} // namespace touchstone
