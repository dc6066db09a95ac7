#include "haptics/safety/force_limiter.h"

#include "engine/device_io/servo_silence.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// `v` shortened to `longest`. Divides by the largest component first: |v|^2 of a finite v may be infinite.
/// The result is slightly shorter than `longest`, so that rounding cannot exceed the limit.
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
/// does too; the last line matters only when the ball itself has shrunk since the last tick.
glm::dvec3 stepTowards(const glm::dvec3& last, const glm::dvec3& target, double most, double maxStep,
                       bool& cut) {
    bool stepCut = false;
    const glm::dvec3 step = shortened(target - last, maxStep, stepCut);
    cut |= stepCut;
    return shortened(stepCut ? last + step : target, most, cut);
}

bool usable(const SafetyInputs& inputs) {
    const DeviceLimits& limits = inputs.limits;
    const auto limit = [](double value) { return std::isfinite(value) && value >= 0.0; };
    return limit(inputs.dt) && limit(limits.maxForce) && limit(limits.maxForceRate) &&
           limit(limits.maxTorque) && limit(limits.maxTorqueRate) && limit(limits.apparentMass) &&
           limit(limits.coulombFriction) && limit(limits.positionResolution);
}

/// Accounts for the work of the last command. The contact's springs store as much of their energy as the ramp
/// passes. The clutch removes none of it: the held point keeps its springs stretched, with work that the hand
/// has done, and returns it when the clutch is released.
void observe(const SafetyInputs& inputs, const glm::dvec3& force, ForceLimiterState& state, uint32_t& flags) {
    if (inputs.passivity == PassivityMode::Off) {
        state.passivity = PassivityState{}; // off: no balance is kept, and none is settled later
        return;
    }
    if (!inputs.inputValid || !finite(inputs.position)) {
        losePosition(state.passivity);
        return;
    }
    const double stored = 0.5 * state.ramp * glm::length(force) * inputs.springLength;
    observeEnergy(state.lastForce, inputs.position, stored, inputs.limits, state.passivity);
    if (state.passivity.balance > kNoticedEnergy)
        flags = flags | TickFlag::EnergyGiven;
}

double coupled(const SafetyInputs& inputs) {
    return inputs.coupling > 0.0 ? std::min(inputs.coupling, 1.0) : 0.0; // also where it is NaN
}

/// `target` after the passivity controller, if it is enabled and the force is on.
glm::dvec3 madePassive(const glm::dvec3& target, const SafetyInputs& inputs, const ForceLimiterState& state,
                       uint32_t& flags, bool& cut) {
    if (inputs.passivity != PassivityMode::Control || !inputs.inputValid || !inputs.forceEnabled ||
        state.latched)
        return target;
    const glm::dvec3 passive =
        passiveForce(target, inputs.dt, inputs.limits, state.passivity, state.ramp * coupled(inputs));
    if (passive == target || !finite(passive))
        return target;
    flags = flags | TickFlag::EnergyDamped;
    return shortened(passive, inputs.limits.maxForce, cut);
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

    observe(inputs, forceInDevice, state, flags);
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
    // After a pause longer than a device holds a force (kServoSilence) the servo starts from zero force, and
    // no tick counts for more than that: else the full force would come at once after a stall.
    const double dt = std::min(inputs.dt, kServoSilence);
    if (inputs.dt > kServoSilence) {
        state.ramp = 0.0;
        state.lastForce = state.lastTorque = glm::dvec3(0.0);
    }
    if (fresh && !state.latched) {
        state.heldForce = coupled(inputs) * shortened(forceInDevice, limits.maxForce, cut);
        state.heldTorque = coupled(inputs) * shortened(torqueInDevice, limits.maxTorque, cut);
        state.ramp = std::min(1.0, state.ramp + dt / kForceRampInTime);
    } else {
        state.ramp = std::max(0.0, state.ramp - dt / kForceRampOutTime);
    }
    if (!inputs.forceEnabled)
        state.ramp = 0.0; // the force-off key does not wait for a fade
    if (state.ramp < 1.0 || coupled(inputs) < 1.0)
        flags = flags | TickFlag::ForceRamping;

    const glm::dvec3 target = madePassive(state.ramp * state.heldForce, inputs, state, flags, cut);
    state.lastForce = stepTowards(state.lastForce, target, limits.maxForce, limits.maxForceRate * dt, cut);
    state.lastTorque = stepTowards(state.lastTorque, state.ramp * state.heldTorque, limits.maxTorque,
                                   limits.maxTorqueRate * dt, cut);
    if (cut)
        flags = flags | TickFlag::ForceLimited;
    return {state.lastForce, state.lastTorque};
}

void ForceLimiter::restartRamp(ForceLimiterState& state) noexcept {
    state.ramp = 0.0;
    state.passivity.balance = 0.0;
    state.heldForce = glm::dvec3(0.0);
    state.heldTorque = glm::dvec3(0.0);
}

} // namespace touchstone
