#pragma once
// The energy that the device gives the hand, J, and the response where it is too much (docs/closed_loop.md,
// Passivity): Hannaford and Ryu, Time-domain passivity control of haptic interfaces, IEEE T-RA 18(1), 2002,
// and a force that yields. Pure functions; part of stage 8.

#include "engine/device_io/device_io.h"

#include <glm/glm.hpp>

namespace touchstone {

/// 1/s. The controller's damper is at most the device's apparentMass times this: by itself it slows the
/// device e-fold in 4 ms. A larger value responds sooner, but amplifies the steps of the position sensor into
/// kicks (0.56 N a step of 30 µm at 75 g and 1 kHz).
inline constexpr double kMaxDampingRate = 250.0;

/// J. The controller reduces the force as the balance rises, to zero at this value. So whatever the wall, the
/// sensor or the delay, the device gives no more than this and the work of the ticks that the slew limit and
/// the delay need until the device holds the reduced force. Ordinary touch stays below a sixth of it
/// (tests/stability/closed_loop/effects_test.cpp); a smaller value makes such touch softer where it is
/// lively.
inline constexpr double kMaxEnergy = 2e-3;

/// J. A balance above this sets a flag: the energy that sampling alone adds in a firm tap (k v² T² / 2 a
/// tick: 0.1 mJ for 20 ticks at 1000 N/m and 0.1 m/s), which hand and device absorb unnoticed.
inline constexpr double kNoticedEnergy = 1e-4;

/// Device frame.
struct PassivityState {
    bool placed = false;      ///< `reading` and `position` are of the last tick
    glm::dvec3 reading{0.0};  ///< m, as the sensor reports it
    glm::dvec3 position{0.0}; ///< m; of all positions consistent with the readings, the one that moved least
    glm::dvec3 way{0.0};      ///< m, displacement since the preceding tick
    glm::dvec3 delayed{0.0};  ///< N, the command before the last: held by a device with one tick of delay
    /// J, the observer: the energy given less the energy taken and that dissipated by the device's own
    /// friction. Above 0 the device was not passive. Energy taken that cannot be stored is lost: it is no
    /// credit for later.
    double balance = 0.0;
};

/// Servo thread, once a tick. `sent`: N, the last command, which the device held over the displacement to
/// here (or holds from here on, with a tick of delay): the work is force times displacement, not an estimate
/// from a velocity. `reading`: m. `stored`: J, the energy that the contact can return (the present energy of
/// its springs), below which the balance does not fall.
///
/// The displacement is that between readings, which overstates the energy of a stiff wall by up to half a
/// sensor's step times the step's force: a buzz between two steps counts, as it should. The device's friction
/// counts for the displacement that is certain (a reading that flickers between two steps may be a hand at
/// rest). A false alarm is then possible only above 2 fc / step, Abbott and Okamura's bound.
void observeEnergy(const glm::dvec3& sent, const glm::dvec3& reading, double stored,
                   const DeviceLimits& limits, PassivityState& state) noexcept;

/// The tick's position is unknown: displacements are measured from the next known position. The balance is
/// kept: a lost sample does not reduce it.
inline void losePosition(PassivityState& state) noexcept {
    state.placed = false;
    state.way = glm::dvec3(0.0);
}

/// The controller, after observeEnergy: the remaining part of `force` (N), which is all of it where the
/// balance is not above zero. The force is scaled by 1 - balance / kMaxEnergy. A damper -a v with a = E / (dt
/// v²) is added, which removes the balance E in one tick if the hand continues at v; at most
/// kMaxDampingRate's, and in addition the force's own push along the motion, whose removal cannot overshoot.
/// `ramp`: 0..1, the fraction at which `force` was passed, which also scales the damper's maximum: at 0 there
/// is no drag.
[[nodiscard]] glm::dvec3 passiveForce(const glm::dvec3& force, double dt, const DeviceLimits& limits,
                                      const PassivityState& state, double ramp) noexcept;

} // namespace touchstone
