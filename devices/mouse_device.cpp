#include "devices/mouse_device.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

MouseDevice::MouseDevice(const MouseSmoothing& smoothing) : smoothing_(smoothing) {}

void MouseDevice::moveTo(const glm::dvec3& goal, uint32_t buttons) noexcept {
    if (!std::isfinite(goal.x) || !std::isfinite(goal.y) || !std::isfinite(goal.z))
        return;
    goal_.write({goal, buttons, true});
}

void MouseDevice::release() noexcept {
    goal_.write({});
}

DeviceSample MouseDevice::sample(double time) noexcept {
    if (goal_.update())
        goalTime_ = time;
    const Goal& goal = goal_.value();
    if (!goal.held) {
        moving_ = false;
        force_ = glm::dvec3(0.0);
        return {};
    }
    if (!moving_) {
        position_ = goal.position;
        velocity_ = glm::dvec3(0.0);
        lastTime_ = time;
        moving_ = true;
    }
    follow(goal.position + force_ / smoothing_.stiffness, std::clamp(time - lastTime_, 0.0, kLongestStep));
    lastTime_ = std::max(lastTime_, time);

    DeviceSample sample;
    sample.position = position_;
    sample.buttons = goal.buttons;
    sample.age = std::max(0.0, time - goalTime_);
    sample.valid = true;
    return sample;
}

/// The exact step of x'' = w^2 (target - x) - 2 w x' for a target that holds still over dt. With the error
/// cut to E = 2 maxSpeed / w the velocity after the step is exp(-a) ((1 - a) v + a w e), a = w dt, so |v| <=
/// maxSpeed before gives at most exp(-a) (|1 - a| + 2 a) maxSpeed <= maxSpeed after: the limit holds without
/// a clamp, and the velocity has no steps.
void MouseDevice::follow(const glm::dvec3& goal, double dt) noexcept {
    const double w = smoothing_.frequency;
    glm::dvec3 error = goal - position_;
    const double distance = glm::length(error), reach = 2.0 * smoothing_.maxSpeed / w;
    if (distance > reach)
        error *= reach / distance;
    const double decay = std::exp(-w * dt);
    const glm::dvec3 pull = (velocity_ - w * error) * dt;
    position_ += error + (pull - error) * decay;
    velocity_ = (velocity_ - w * pull) * decay;
}

} // namespace touchstone
