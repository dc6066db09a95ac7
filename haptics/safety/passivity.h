#pragma once
// What the device gives the hand, in joules, and a damper that takes back what it gave too much (DESIGN §9):
// Hannaford and Ryu, Time-domain passivity control of haptic interfaces, IEEE T-RA 18(1), 2002. Pure
// functions; part of stage 8.

#include "engine/device_io/device_io.h"

#include <glm/glm.hpp>

namespace touchstone {

/// 1/s. The controller's damper is at most the device's apparentMass times this: by itself it slows the
/// device e-fold in 4 ms. Faster answers sooner, but multiplies the steps of the position sensor into kicks
/// (0.56 N a step of 30 µm at 75 g and 1 kHz).
inline constexpr double kMostDampingRate = 250.0;

/// J. A balance above this is worth a flag: the energy that sampling alone gives in a firm tap (k v² T² / 2 a
/// tick: 0.1 mJ for 20 ticks at 1000 N/m and 0.1 m/s), which hand and device swallow unnoticed.
inline constexpr double kNoticedEnergy = 1e-4;

/// Device frame.
struct PassivityState {
    bool placed = false;      ///< `position` is where the hand was in the last tick
    glm::dvec3 position{0.0}; ///< m
    glm::dvec3 way{0.0};      ///< m since the tick before
    /// J, the observer: what was given beyond what was taken and what the device's own friction takes. Above
    /// 0 the device was not passive. What was taken and cannot be stored is lost: it is no credit for later.
    double balance = 0.0;
};

/// Servo thread, once a tick. `held`: N, the force since the last tick, which the device held over the way to
/// `position` (m): so the work is exact, not an estimate. `stored`: J, what the contact can give back (the
/// energy of its springs now), below which the balance does not fall.
void observeEnergy(const glm::dvec3& held, const glm::dvec3& position, double stored,
                   const DeviceLimits& limits, PassivityState& state) noexcept;

/// The tick's position is not known: the observer begins anew where the hand is next seen.
inline void losePosition(PassivityState& state) noexcept {
    state.placed = false;
    state.way = glm::dvec3(0.0);
}

/// The controller, after observeEnergy: N, to be added to `force` (N, what would be sent). A damper -a v with
/// a = E / (dt v²), which takes the balance E back in one tick if the hand goes on at v; at most
/// kMostDampingRate's, and on top of that what `force` itself pushes along the motion, which taking away
/// cannot overshoot. Zero where the balance is not above zero or the hand rests.
[[nodiscard]] glm::dvec3 passivityDamping(const glm::dvec3& force, double dt, const DeviceLimits& limits,
                                          const PassivityState& state) noexcept;

} // namespace touchstone
