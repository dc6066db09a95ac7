#pragma once
// Stage 2 in a scene that moves: what the objects do to the proxy between two ticks.

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

#include <cstdint>

namespace touchstone {

/// Takes a placed proxy (radius in workspace metres) from the last tick's poses to this tick's, through no
/// surface of any object at any speed. What touches nothing stays where it is in the workspace; what is run
/// into is pushed, slides between the surfaces that push and those that stand, and comes to rest as near to
/// where it was as they allow.
///
/// Where objects close on each other and leave no way out the proxy stays with the one that it touched last
/// and the others are not felt (TickFlag::Jammed) until it is in front of them again; when one has gone on
/// by half its longest side touch begins anew. An object that jumps (ObjectMotion::jumped) does not sweep:
/// the proxy stays where it was in the workspace if that is free now; else `state.placed` becomes false and
/// touch begins anew.
///
/// Costs nothing in a scene at rest; with one object its motion is the whole relative motion and the sweep to
/// the HIP covers it. Bounded, no allocation. Sets bits of TickFlag in `flags`.
void sweepMovingObstacles(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state,
                          uint32_t& flags) noexcept;

} // namespace touchstone
