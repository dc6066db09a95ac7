#pragma once
// Stage 8 of a contact location display: the place of the finger's pad that touches, made a command.

#include "engine/device_io/device_io.h"
#include "engine/device_io/pad_command.h"
#include "haptics/safety/location_limiter.h"

#include <glm/glm.hpp>

namespace touchstone {

struct HapticOutput;

/// What one tick shows on a hand's display; zeros where it has none.
struct PadTick {
    PadLimits limits;         ///< input: the display of this tick
    glm::dvec2 before{0.0};   ///< m, the place before the tick: all that outlives one
    glm::dvec2 location{0.0}; ///< m, of the command
};

/// The location follows from the direction of this tick's spring, which lies along the shaded normal, and
/// from the sample's orientation. It stays where it is while the force is off or has failed, and while the
/// position is unknown: a roller that moves on without its force is a motion on the skin that nobody
/// commanded. Deterministic; servo thread.
[[nodiscard]] PadCommand padStep(const DeviceSample& sample, const HapticOutput& output, bool forceEnabled,
                                 double dt, const PadLimits& limits, LocationLimiterState& state) noexcept;

} // namespace touchstone
