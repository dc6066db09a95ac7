#include "haptics/safety/passivity.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

void observeEnergy(const glm::dvec3& held, const glm::dvec3& position, double stored,
                   const DeviceLimits& limits, PassivityState& state) noexcept {
    if (!state.placed) {
        state.placed = true;
        state.position = position;
        state.way = glm::dvec3(0.0);
        return;
    }
    state.way = position - state.position;
    state.position = position;
    const double work = glm::dot(held, state.way);
    // Either end of the way is off by half a step of the sensor on each axis: only what is beyond that is
    // sure.
    constexpr double kRootThree = 1.7320508075688772;
    const double sure = glm::length(state.way) - kRootThree * limits.positionResolution;
    const double friction = limits.coulombFriction * std::max(0.0, sure);
    const double balance = std::max(state.balance + work - friction, -stored);
    if (std::isfinite(balance))
        state.balance = balance;
    else
        losePosition(state); // no place that a hand can be in
}

glm::dvec3 passivityDamping(const glm::dvec3& force, double dt, const DeviceLimits& limits,
                            const PassivityState& state) noexcept {
    const double square = glm::dot(state.way, state.way);
    if (!(state.balance > 0.0) || !(square > 0.0) || !(dt > 0.0))
        return glm::dvec3(0.0);
    // In terms of the way w = v dt: a v = (a / dt) w, and a = E / (dt v²) makes that E / w² times w. A
    // sampled damper beyond mass / dt turns the motion round; half of that leaves room for what is late by a
    // tick.
    const double most = limits.apparentMass * std::min(kMostDampingRate, 0.5 / dt) / dt;
    const double pushed = std::max(0.0, glm::dot(force, state.way)) / square;
    return -std::min(state.balance / square, most + pushed) * state.way;
}

} // namespace touchstone
