#pragma once

#include "haptics/safety/force_limiter.h"

namespace touchstone::test {

/// The command that sends this force (N), for the tests of devices: only the limiter makes commands.
[[nodiscard]] inline DeviceCommand command(const glm::dvec3& force) {
    SafetyInputs inputs;
    inputs.inputValid = true;
    inputs.dt = 10.0; // s: no slew limit, no ramp
    ForceLimiterState state;
    uint32_t flags = 0;
    return ForceLimiter::limit(force, glm::dvec3(0.0), inputs, {}, state, flags);
}

} // namespace touchstone::test
