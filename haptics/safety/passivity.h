#pragma once
// What the device gives the hand, in joules, and what is done where it gave too much (docs/closed_loop.md,
// Passivity): Hannaford and Ryu, Time-domain passivity control of haptic interfaces, IEEE T-RA 18(1), 2002,
// and a force that yields. Pure functions; part of stage 8.

#include "engine/device_io/device_io.h"

#include <glm/glm.hpp>

namespace touchstone {

/// 1/s. The controller's damper is at most the device's apparentMass times this: by itself it slows the
/// device e-fold in 4 ms. Faster answers sooner, but multiplies the steps of the position sensor into kicks
/// (0.56 N a step of 30 µm at 75 g and 1 kHz).
inline constexpr double kMaxDampingRate = 250.0;

/// J. The controller lets the force yield as the balance rises, until at this none is left: so whatever the
/// wall, the sensor or the delay, no more than this can be given, and the work of the ticks that the slew
/// limit and the delay need until the yielded force is what the device holds. Ordinary touch stays below a
/// sixth of it (tests/stability/closed_loop/effects_test.cpp); less makes such touch softer where it is
/// lively.
inline constexpr double kMaxEnergy = 2e-3;

/// J. A balance above this is worth a flag: the energy that sampling alone gives in a firm tap (k v² T² / 2 a
/// tick: 0.1 mJ for 20 ticks at 1000 N/m and 0.1 m/s), which hand and device swallow unnoticed.
inline constexpr double kNoticedEnergy = 1e-4;

/// Device frame.
struct PassivityState {
    bool placed = false;      ///< `reading` and `position` are of the last tick
    glm::dvec3 reading{0.0};  ///< m, of the sensor
    glm::dvec3 position{0.0}; ///< m; of all places that the readings allow, the one that moved least
    glm::dvec3 way{0.0};      ///< m that it moved since the tick before
    glm::dvec3 delayed{0.0};  ///< N, the command before the last: what a device with a tick of delay has held
    /// J, the observer: what was given beyond what was taken and what the device's own friction takes. Above
    /// 0 the device was not passive. What was taken and cannot be stored is lost: it is no credit for later.
    double balance = 0.0;
};

/// Servo thread, once a tick. `sent`: N, the last command, which the device held over the way to here (or
/// holds from here on, with a tick of delay): the work is force times way, not an estimate from a velocity.
/// `reading`: m. `stored`: J, what the contact can give back (the energy of its springs now), below which the
/// balance does not fall.
///
/// The way is that between readings, which overstates what a stiff wall gives by up to half a sensor's step
/// times the step's force: a buzz between two steps counts, as it should. The device's friction counts for
/// the way that the hand has gone for sure (a reading that flickers between two steps may be a hand at rest).
/// A false alarm is then possible only above 2 fc / step, Abbott and Okamura's bound.
void observeEnergy(const glm::dvec3& sent, const glm::dvec3& reading, double stored,
                   const DeviceLimits& limits, PassivityState& state) noexcept;

/// The tick's position is not known: ways are measured from where the hand is next seen. The balance stays: a
/// lost sample is no payment.
inline void losePosition(PassivityState& state) noexcept {
    state.placed = false;
    state.way = glm::dvec3(0.0);
}

/// The controller, after observeEnergy: N, what is left of `force` (N), which is all of it where the balance
/// is not above zero. It yields by balance / kMaxEnergy. A damper -a v with a = E / (dt v²) is added, which
/// takes the balance E back in one tick if the hand goes on at v; at most kMaxDampingRate's, and on top of
/// that what the force itself pushes along the motion, which taking away cannot overshoot. `ramp`: 0..1, the
/// share that `force` was let pass, which holds for the most of the damper too: at 0 nothing drags.
[[nodiscard]] glm::dvec3 passiveForce(const glm::dvec3& force, double dt, const DeviceLimits& limits,
                                      const PassivityState& state, double ramp) noexcept;

} // namespace touchstone
