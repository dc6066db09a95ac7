#include "devices/hid/rate_hand.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Quadratic beyond the dead zone: fine near the centre, fast at full deflection, without a step.
glm::dvec3 shaped(const glm::dvec3& deflection, double deadZone) {
    glm::dvec3 result(0.0);
    for (int i = 0; i < 3; ++i) {
        const double size = std::abs(deflection[i]);
        if (!(size > deadZone)) // also excludes NaN
            continue;
        const double share = std::min(1.0, (size - deadZone) / (1.0 - deadZone));
        result[i] = std::copysign(share * share, deflection[i]);
    }
    return result;
}

} // namespace

void RateHand::follow(const DeviceReading& reading, bool fresh, double dt) noexcept {
    const double step = std::clamp(dt, 0.0, kLongestStep);
    const double share = 1.0 - std::exp(-settings_.smoothing * step);
    const glm::dvec3 speed =
        fresh ? settings_.fullSpeed * shaped(reading.push, settings_.deadZone) : glm::dvec3(0.0);
    const glm::dvec3 spin =
        fresh ? settings_.fullTurn * shaped(reading.turn, settings_.deadZone) : glm::dvec3(0.0);
    velocity_ += share * (speed - velocity_);
    spin_ += share * (spin - spin_);
    const glm::dvec3 wanted = position_ + velocity_ * step;
    position_ = glm::clamp(wanted, glm::dvec3(-settings_.reach), glm::dvec3(settings_.reach));
    for (int i = 0; i < 3; ++i)
        if (position_[i] != wanted[i])
            velocity_[i] = 0.0; // the edge of the workspace
    const double angle = glm::length(spin_) * step;
    if (angle > 0.0)
        orientation_ = glm::normalize(glm::angleAxis(angle, glm::normalize(spin_)) * orientation_);
}

} // namespace touchstone
