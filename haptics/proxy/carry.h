#pragma once

#include "haptics/device_state.h"
#include "haptics/haptic_scene.h"
#include "haptics/object_motion.h"

namespace touchstone {

/// Sweeps a placed proxy (`radius` in workspace metres) along what the objects did since the last tick. An
/// object that runs into it becomes the anchor and carries it.
void carryProxy(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state) noexcept;

} // namespace touchstone
