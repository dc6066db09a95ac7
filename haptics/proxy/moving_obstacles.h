#pragma once
// Stage 2 in a moving scene: how the objects displace the proxy between two ticks.

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

#include <cstdint>

namespace touchstone {

/// Moves a placed proxy (radius in workspace metres) from the last tick's poses to this tick's, through no
/// surface of any object at any speed. A proxy without contact stays in place in the workspace. A proxy that
/// is hit is pushed, slides between moving and resting surfaces, and comes to rest as near to its former
/// place as they allow.
///
/// Where objects close and leave no way out, the proxy stays with the one that it touched last and the others
/// are not felt (TickFlag::Jammed) until the proxy is in front of them again; when one has moved on by half
/// its longest side, touch begins again. An object that jumps (ObjectMotion::jumped) does not sweep: the
/// proxy stays in place in the workspace if that place is free; else `state.placed` becomes false and touch
/// begins again.
///
/// Costs nothing in a scene at rest; with one object its motion is the whole relative motion and the sweep to
/// the HIP covers it. Bounded, no allocation. Sets bits of TickFlag in `flags`.
void sweepMovingObstacles(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state,
                          uint32_t& flags) noexcept;

} // namespace touchstone
