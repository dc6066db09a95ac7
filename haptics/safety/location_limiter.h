#pragma once
// Stage 8 of a contact location: range and rate, as force_limiter.h's of a force. Pure: all state is in the
// state.

#include "engine/device_io/pad_command.h"
#include "haptics/settings/tick_flags.h"

namespace touchstone {

struct LocationLimiterState {
    glm::dvec2 last{0.0}; ///< m, the last command
};

struct LocationInput {
    glm::dvec2 wanted{0.0}; ///< m along and across
    bool touching = false;
    /// The force is on and has not failed, and the hand's position is known.
    bool forceFelt = false;
    PadLimits limits;
    double dt = 0.0; ///< s since the last command
};

/// LocationInput::forceFelt of a tick with these flags.
[[nodiscard]] constexpr bool isForceFelt(bool forceOn, bool placeKnown, uint32_t flags) {
    return forceOn && placeKnown && !has(flags, TickFlag::ForceFault) && !has(flags, TickFlag::SafetyLatched);
}

/// Makes every PadCommand. Invariants, for any input:
/// - the command is finite and |location| <= limits.reach; a device without a display gets the middle;
/// - |location - previous location| <= limits.rate dt, except where the reach has become smaller, and dt
/// counts for at
///   most kServoSilence;
/// - without contact, and where `wanted` is not finite, the location stays where it is: the display does not
///   tell a finger in the air where a surface would be;
/// - so it does without force, from that tick on: nothing moves on the skin that nobody commanded. With the
///   force it goes on from there at the display's rate.
class LocationLimiter {
  public:
    /// Servo thread.
    [[nodiscard]] static PadCommand limit(const LocationInput& input, LocationLimiterState& state) noexcept;
};

} // namespace touchstone
