#include "haptics/safety/force_limiter.h"

#include "haptics/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// `v` shortened to `longest`. Divides by the largest component first: |v|^2 of a finite v may be infinite.
/// The result is a hair short of `longest`, so that rounding cannot carry it over the limit.
glm::dvec3 shortened(const glm::dvec3& v, double longest, bool& cut) {
    constexpr double kHairShort = 1.0 - 1e-15;
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest <= 0.0)
        return v;
    const glm::dvec3 unit = v / largest;
    const double length = glm::length(unit); // 1..sqrt(3)
    if (length * largest <= longest)
        return v;
    cut = true;
    return unit * (longest * kHairShort / length);
}

/// One step from `last` towards `target`. Both lie in the ball of radius `most`, which is convex, so the step
/// does too; the last line only matters when the ball itself has shrunk since the last tick.
glm::dvec3 stepTowards(const glm::dvec3& last, const glm::dvec3& target, double most, double mostStep,
                       bool& cut) {
    bool stepCut = false;
    const glm::dvec3 step = shortened(target - last, mostStep, stepCut);
    cut |= stepCut;
    return shortened(stepCut ? last + step : target, most, cut);
}

bool usable(const SafetyInputs& inputs) {
    const DeviceLimits& limits = inputs.limits;
    const auto limit = [](double value) { return std::isfinite(value) && value >= 0.0; };
    return limit(inputs.dt) && limit(limits.maxForce) && limit(limits.maxForceRate) &&
           limit(limits.maxTorque) && limit(limits.maxTorqueRate);
}

} // namespace

DeviceCommand ForceLimiter::limit(const glm::dvec3& force, const glm::dvec3& torque,
                                  const SafetyInputs& inputs, const Similarity& workspaceFromDevice,
                                  ForceLimiterState& state, uint32_t& flags) noexcept {
    const glm::dquat deviceFromWorkspace = glm::conjugate(workspaceFromDevice.rotation);
    const glm::dvec3 forceInDevice = deviceFromWorkspace * force;
    const glm::dvec3 torqueInDevice = deviceFromWorkspace * torque;
    if (!finite(forceInDevice) || !finite(torqueInDevice) || !usable(inputs)) {
        const uint32_t faults = state.faults + 1;
        state = ForceLimiterState{};
        state.faults = faults;
        state.latched = true;
        flags = flags | TickFlag::ForceFault | TickFlag::SafetyLatched;
        return DeviceCommand{};
    }

    state.lateInARow = inputs.late ? state.lateInARow + 1 : 0;
    if (state.lateInARow >= kLateTicksToLatch)
        state.latched = true;
    if (!inputs.forceEnabled)
        state.latched = false;
    if (state.latched)
        flags = flags | TickFlag::SafetyLatched;

    const bool fresh =
        inputs.inputValid && inputs.sampleAge <= inputs.limits.staleAge; // a NaN age is not fresh
    if (!fresh)
        flags = flags | TickFlag::InputInvalid;
    const DeviceLimits& limits = inputs.limits;
    bool cut = false;
    if (fresh && !state.latched) {
        state.heldForce = shortened(forceInDevice, limits.maxForce, cut);
        state.heldTorque = shortened(torqueInDevice, limits.maxTorque, cut);
        state.ramp = std::min(1.0, state.ramp + inputs.dt / kForceRampInTime);
    } else {
        state.ramp = std::max(0.0, state.ramp - inputs.dt / kForceRampOutTime);
    }
    if (!inputs.forceEnabled)
        state.ramp = 0.0; // the force-off key does not wait for a fade
    if (state.ramp < 1.0)
        flags = flags | TickFlag::ForceRamping;

    state.lastForce = stepTowards(state.lastForce, state.ramp * state.heldForce, limits.maxForce,
                                  limits.maxForceRate * inputs.dt, cut);
    state.lastTorque = stepTowards(state.lastTorque, state.ramp * state.heldTorque, limits.maxTorque,
                                   limits.maxTorqueRate * inputs.dt, cut);
    if (cut)
        flags = flags | TickFlag::ForceLimited;
    return {state.lastForce, state.lastTorque};
}

void ForceLimiter::restartRamp(ForceLimiterState& state) noexcept {
    state.ramp = 0.0;
    state.heldForce = glm::dvec3(0.0);
    state.heldTorque = glm::dvec3(0.0);
}

} // namespace touchstone
