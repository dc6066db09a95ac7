#include "haptics/safety/passivity.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

void observeEnergy(const glm::dvec3& sent, const glm::dvec3& reading, double stored,
                   const DeviceLimits& limits, PassivityState& state) noexcept {
    const glm::dvec3 held = limits.commandDelay ? state.delayed : sent;
    state.delayed = sent;
    if (!state.placed) {
        state.placed = true;
        state.position = state.reading = reading;
        state.way = glm::dvec3(0.0);
        return;
    }
    const double work = glm::dot(held, reading - state.reading);
    const double reach = 0.5 * limits.positionResolution;
    const glm::dvec3 position = glm::clamp(state.position, reading - reach, reading + reach);
    state.way = position - state.position;
    state.position = position;
    state.reading = reading;
    const double friction = limits.coulombFriction * glm::length(state.way);
    const double balance = std::max(state.balance + work - friction, -stored);
    if (std::isfinite(balance))
        state.balance = balance;
    else
        losePosition(state); // not a position that a hand can have
}

glm::dvec3 passiveForce(const glm::dvec3& force, double dt, const DeviceLimits& limits,
                        const PassivityState& state, double ramp) noexcept {
    if (!(state.balance > 0.0))
        return force;
    const glm::dvec3 left = std::max(0.0, 1.0 - state.balance / kMaxEnergy) * force;
    const double square = glm::dot(state.way, state.way);
    if (!(square > 0.0) || !(dt > 0.0))
        return left;
    // In terms of the displacement w = v dt: a v = (a / dt) w, and a = E / (dt v²) makes that E / w² times w.
    // A sampled damper beyond mass / dt reverses the motion; half of that leaves room for a delay of one
    // tick.
    const double most = ramp * limits.apparentMass * std::min(kMaxDampingRate, 0.5 / dt) / dt;
    const double pushed = std::max(0.0, glm::dot(left, state.way)) / square;
    return left - std::min(state.balance / square, most + pushed) * state.way;
}

} // namespace touchstone
