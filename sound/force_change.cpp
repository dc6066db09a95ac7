#include "sound/force_change.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

/// Second-order Butterworth high-pass by trapezoidal integration, whose poles stay correct when dt changes
/// from tick to tick (Zavalishin, The Art of VA Filter Design, 4.1).
glm::dvec3 ForceChange::highPass(const glm::dvec3& force, double dt) noexcept {
    if (dt != filterDt_) {
        filterDt_ = dt;
        filterGain_ = std::tan(std::numbers::pi * std::min(kLowest * dt, 0.45));
        meanShare_ = -std::expm1(-dt / kMeanTime);
    }
    const double g = filterGain_, damping = std::numbers::sqrt2;
    const glm::dvec3 high = (force - (g + damping) * band_ - low_) / (1.0 + g * (g + damping));
    const glm::dvec3 band = band_ + g * high, low = low_ + g * band;
    band_ = band + g * high;
    low_ = low + g * band;
    return high;
}

ForceRates ForceChange::add(const SoundTick& tick) noexcept {
    if (!begun_) {
        begun_ = true;
        low_ = meanForce_ = tick.force; // a force present at the start is no change
        position_ = tick.position;
        handKnown_ = tick.handKnown;
    }
    const glm::dvec3 before = quick_;
    quick_ = highPass(tick.force, tick.dt);
    const glm::dvec3 rate = (quick_ - before) / tick.dt;

    const bool moved = handKnown_ && tick.handKnown; // otherwise it may have reappeared elsewhere
    const glm::dvec3 velocity = moved ? (tick.position - position_) / tick.dt : glm::dvec3(0.0);
    position_ = tick.position;
    handKnown_ = tick.handKnown;
    meanForce_ += meanShare_ * (tick.force - meanForce_);
    meanVelocity_ += meanShare_ * (velocity - meanVelocity_);

    const glm::dvec3 pressing = meanForce_ / (glm::length(meanForce_) + kFaint);
    const glm::dvec3 across = meanVelocity_ - glm::dot(meanVelocity_, pressing) * pressing;
    const glm::dvec3 dragging = across / (glm::length(across) + kSlow);
    // Bodies that meet exert their impulse within the tick. It has no direction of the hand's: it is
    // pressing.
    const double met = meeting_;
    meeting_ = std::max(tick.impact - kResting, 0.0) / tick.dt;
    return {static_cast<float>(glm::dot(rate, pressing) + (meeting_ - met) / tick.dt),
            static_cast<float>(glm::dot(rate, dragging))};
}

} // namespace touchstone
