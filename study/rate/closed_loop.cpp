#include "study/rate/closed_loop.h"

#include "haptics/servo/realtime_thread.h"

#include <cmath>

namespace touchstone::study {

DeviceLimits noLimits() {
    DeviceLimits limits;
    limits.maxForce = 1e9;
    limits.maxForceRate = 1e15;
    limits.positionResolution = 0.0;
    limits.coulombFriction = 0.0;
    return limits;
}

ClosedLoop::ClosedLoop(const HapticScene& scene, const HapticSettings& settings, const PlantParameters& plant,
                       double rateHz, const DeviceLimits& limits)
    : touch_(scene), settings_(settings), limits_(limits), rate_(rateHz), hand_(target_, plant) {}

const HapticOutput& ClosedLoop::step(const glm::dvec3& position) {
    DeviceSample sample = sampleAt(position);
    sample.limits = limits_;
    NoStopwatch none;
    const int64_t begin = monotonicNs();
    const HapticOutput& output = touch_.step(settings_, sample, 1.0 / rate_, none);
    stepNs = monotonicNs() - begin;
    return output;
}

void ClosedLoop::hold(const glm::dvec3& outside, const glm::dvec3& position) {
    (void)step(outside);
    const int ticks = static_cast<int>(std::ceil(1.1 * kForceRampInTime * rate_));
    for (int i = 0; i < ticks; ++i)
        (void)step(position);
}

void ClosedLoop::release(const glm::dvec3& position, const glm::dvec3& velocity) {
    (void)hand_.sample(static_cast<double>(ticks_) / rate_);
    hand_.plant().place(position, velocity);
    hand_.push(step(hand_.plant().measured()).command.force() + weight);
}

const HapticOutput& ClosedLoop::tick() {
    const double time = static_cast<double>(++ticks_) / rate_;
    const HapticOutput& output = step(hand_.sample(time).position);
    hand_.push(output.command.force() + weight);
    return output;
}

} // namespace touchstone::study
