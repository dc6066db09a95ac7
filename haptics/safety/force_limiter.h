#pragma once
// Stage 8: the only source of device commands (docs/architecture.md, One tick). Pure: all state is in
// ForceLimiterState.

#include "engine/device_io/device_io.h"
#include "engine/math/similarity.h"
#include "haptics/safety/passivity.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// s from no force to full force after enabling, after a start and after a scene swap. Longer is gentler to a
/// hand that happens to be inside the new surface, but the first touch feels soft for that long.
inline constexpr double kForceRampInTime = 0.1;

/// s from full force to none once the input is stale. Shorter stops sooner, longer avoids the kick of a force
/// that vanishes under a pressing hand.
inline constexpr double kForceRampOutTime = 0.05;

/// Consecutive late ticks after which the loop counts as broken: the force fades out and stays off (latched).
/// Fewer trips on a busy desktop; more lets a loop that runs at half its rate go unstable for longer.
inline constexpr uint32_t kLateTicksToLatch = 20;

/// State of the limiter from tick to tick. Device frame.
struct ForceLimiterState {
    glm::dvec3 lastForce{0.0};  ///< N, the last command
    glm::dvec3 lastTorque{0.0}; ///< N·m
    glm::dvec3 heldForce{0.0};  ///< N, last force from fresh input: fades out when the input goes stale
    glm::dvec3 heldTorque{0.0}; ///< N·m
    double ramp = 0.0;          ///< 0..1, fraction of the force that passes
    uint32_t lateInARow = 0;    ///< late ticks
    uint32_t faults = 0;        ///< ticks with a force that was not finite, since the start
    bool latched = false;       ///< no force until it is switched off and on again
    PassivityState passivity;
};

/// Input of the limiter besides the force.
struct SafetyInputs {
    DeviceLimits limits;
    double dt = 1e-3;         ///< s since the last command
    bool inputValid = false;  ///< the device sample is valid and finite
    double sampleAge = 0.0;   ///< s
    bool forceEnabled = true; ///< false: the force-off key
    bool late = false;        ///< the previous tick ended after its next deadline
    PassivityMode passivity = PassivityMode::Off;
    glm::dvec3 position{0.0};  ///< m, device frame, while inputValid
    double springLength = 0.0; ///< m: half of it times the force is the energy stored in the contact's spring
    double coupling = 1.0;     ///< 0..1: fraction of the force that the clutch passes
};

/// Makes every DeviceCommand. Invariants, for any input:
/// - the command is finite and |force| <= limits.maxForce (torque likewise with maxTorque);
/// - |force - previous force| <= limits.maxForceRate * dt, with two exceptions, both towards less force: a
///   force, a dt or a limit that is not finite is a fault, and a fault drops the command to zero at once;
///   where limits.maxForce has become smaller (another device's limits) the command is cut to it at once
///   (torque likewise);
/// - a coupling of 0 brings the force to zero at that rate, whatever it was; NaN counts as 0, a value above 1
///   as 1; below 1 the force counts as faded, by ForceRamping;
/// - the passivity controller's force has the same limits, and is off wherever the force is off.
class ForceLimiter {
  public:
    /// Servo thread. `force` in N and `torque` in N·m in the workspace; the command is in the device frame,
    /// to which `workspaceFromDevice` rotates it (its scale and translation do not act on forces: zooming a
    /// model changes how far the hand moves, not how hard it pushes). Sets ForceLimited, ForceFault,
    /// ForceRamping, SafetyLatched, InputInvalid, EnergyGiven and EnergyDamped in `flags`.
    [[nodiscard]] static DeviceCommand limit(const glm::dvec3& force, const glm::dvec3& torque,
                                             const SafetyInputs& inputs,
                                             const Similarity& workspaceFromDevice, ForceLimiterState& state,
                                             uint32_t& flags) noexcept;

    /// Servo thread, at a scene swap: the force fades in again. The last command is kept, since the device
    /// still holds it and the slew limit must start from it; so is a latch. The energy balance is reset: it
    /// belongs to the touch that ended.
    static void restartRamp(ForceLimiterState& state) noexcept;
    /// Servo thread, where another device is taken up: its balance begins at zero.
    static void forgetEnergy(ForceLimiterState& state) noexcept { state.passivity.balance = 0.0; }
};

} // namespace touchstone
