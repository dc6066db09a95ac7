#pragma once

#include "haptics/safety/force_limiter.h"

namespace touchstone::test {

/// The command that sends this force (N), for the tests of devices: only the limiter makes commands.
[[nodiscard]] inline DeviceCommand command(const glm::dvec3& force) {
    SafetyInputs inputs;
    inputs.inputValid = true;
    ForceLimiterState state;
    uint32_t flags = 0;
    DeviceCommand command;
    for (double t = 0.0; t < 2.0 * kForceRampInTime; t += inputs.dt) // past the fade
        command = ForceLimiter::limit(force, glm::dvec3(0.0), inputs, {}, state, flags);
    return command;
}

} // namespace touchstone::test
