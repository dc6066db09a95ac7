#include "devices/mouse/mouse_device.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Direction of the part of `stretch` that the planes hold back, without the part that friction adds along
/// them. With one plane, its normal; with three or none, the direction of `stretch`.
glm::dvec3 normalPart(const glm::dvec3& stretch, std::span<const glm::dvec3> planes) {
    constexpr double kMin = 1e-9; // of the stretch, and of a unit vector: nearly parallel planes
    glm::dvec3 along(0.0);
    std::array<glm::dvec3, 3> basis{};
    size_t count = 0;
    for (glm::dvec3 axis : planes) {
        for (size_t i = 0; i < count; ++i)
            axis -= glm::dot(axis, basis[i]) * basis[i];
        const double length = glm::length(axis);
        if (!(length > kMin) || count == basis.size())
            continue;
        basis[count] = axis / length;
        along += glm::dot(stretch, basis[count]) * basis[count];
        ++count;
    }
    const double length = glm::length(along);
    return length > kMin * glm::length(stretch) ? along / length : glm::normalize(stretch);
}

} // namespace

MouseDevice::MouseDevice(const MouseSmoothing& smoothing) : smoothing_(smoothing) {}

void MouseDevice::moveTo(const MouseGoal& goal) noexcept {
    if (finite(goal.position) && goal.press >= 0.0 && goal.stiffness > 0.0 && goal.friction >= 0.0 &&
        std::isfinite(goal.grip))
        told_.write({goal, true, releases_});
}

void MouseDevice::release() noexcept {
    told_.write({{}, false, ++releases_});
}

void MouseDevice::feel(const TouchFeedback& felt) noexcept {
    felt_ = felt;
    const size_t count = std::min(felt.planes.size(), planes_.size());
    std::copy_n(felt.planes.begin(), count, planes_.begin());
    felt_.planes = {planes_.data(), count};
    felt_.touching = felt.touching && finite(felt.force) && finite(felt.proxy) && finite(felt.hip);
    if (!felt_.touching)
        felt_.force = glm::dvec3(0.0);
}

DeviceLimits MouseDevice::limits() const {
    DeviceLimits limits;
    if (presses_)
        limits.press = std::max(press_, kHoverForce);
    return limits;
}

const ObjectMotion* MouseDevice::motionOf(int object) const noexcept {
    return object >= 0 && static_cast<size_t>(object) < felt_.objects.size()
               ? &felt_.objects[static_cast<size_t>(object)]
               : nullptr;
}

DeviceSample MouseDevice::sample(double time) noexcept {
    told_.update();
    const auto& [goal, held, releases] = told_.value();
    const ObjectMotion* const carrier = motionOf(goal.object);
    DeviceSample sample;
    sample.inSight = true;
    if (!held || (goal.object >= 0 && carrier == nullptr)) {
        moving_ = false;
        return sample;
    }
    const glm::dvec3 to =
        carrier != nullptr ? carrier->workspaceFromObject.point(goal.position) : goal.position;
    if (!moving_ || begunAfter_ != releases) {
        position_ = to;
        velocity_ = glm::dvec3(0.0);
        felt_ = TouchFeedback{};
        lastTime_ = time;
        begunAfter_ = releases;
        press_ = goal.press;
        presses_ = false;
        moving_ = sample.begins = true;
    }
    const double dt = std::clamp(time - lastTime_, 0.0, kLongestStep);
    easePress(dt);
    rideAlong();
    const glm::dvec3 from = position_;
    follow(to + felt_.force / smoothing_.stiffness, dt);
    boundPress(from);
    lastTime_ = std::max(lastTime_, time);
    sample.position = position_;
    sample.buttons = goal.buttons;
    sample.valid = true;
    presses_ = goal.press > 0.0 || (presses_ && felt_.touching && press_ > kHoverForce);
    sample.mapping.coupling = presses_ ? 1.0 : 0.0;
    return sample;
}

/// Releasing a press does not throw the hand out: the permitted press falls more slowly than the free
/// response of the hand, (1 + w t) exp(-w t).
void MouseDevice::easePress(double dt) noexcept {
    constexpr double kSlower = 0.25;
    const double asked = told_.value().goal.press;
    const double before = std::isfinite(press_) ? press_ : glm::length(felt_.force);
    press_ = std::isfinite(asked) ? std::max(asked, before * std::exp(-kSlower * smoothing_.frequency * dt))
                                  : asked;
}

/// Hand and contact move with the objects, so that their motion in a tick presses on nothing. An object that
/// was teleported moves nothing.
void MouseDevice::rideAlong() noexcept {
    if (const ObjectMotion* motion = motionOf(told_.value().goal.object);
        motion != nullptr && !motion->jumped) {
        position_ = motion->workspaceFromObject.point(motion->before.inversePoint(position_));
        velocity_ =
            motion->workspaceFromObject.rotation * (glm::conjugate(motion->before.rotation) * velocity_);
    }
    if (const ObjectMotion* motion = motionOf(felt_.object); motion != nullptr && !motion->jumped) {
        const auto moved = [motion](const glm::dvec3& p) {
            return motion->workspaceFromObject.point(motion->before.inversePoint(p));
        };
        const auto turned = [motion](const glm::dvec3& v) {
            return motion->workspaceFromObject.rotation * (glm::conjugate(motion->before.rotation) * v);
        };
        felt_.proxy = moved(felt_.proxy);
        felt_.hip = moved(felt_.hip);
        felt_.force = turned(felt_.force);
        for (glm::dvec3& plane : planes_)
            plane = turned(plane);
    }
}

/// The exact step of x'' = w^2 (target - x) - 2 w x' for a target at rest over dt. With the error clamped to
/// E = 2 maxSpeed / w the velocity after the step is exp(-a) ((1 - a) v + a w e), a = w dt. So |v| <=
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

/// Keeps the hand from sinking deeper than the given press allows. With the last tick's force F, normal part
/// N along n and tangential part T, a hand that moves deeper by e feels N + k e along n: so e <=
/// (sqrt(press^2 - T^2) - N) / k. T grows by at most k times the displacement along the surface (and by
/// MouseGoal::grip, of what friction holds). Friction holds no more than mu N, and N with mu N reaches the
/// whole press at T = press mu / sqrt(1
/// + mu^2). The last proxy's position, moved with its object, is free: the proxy of this tick is no farther
/// from the hand. In the air, where the next surface may be anywhere and have the maximum stiffness, a
/// pressing hand moves by press / k for that stiffness in a tick. Where it slides onto a stiffer surface than
/// the last tick's, it bears no more in that tick (DeviceLimits::press), and comes up in the next.
void MouseDevice::boundPress(const glm::dvec3& from) noexcept {
    const MouseGoal& goal = told_.value().goal;
    if (!std::isfinite(press_))
        return;
    const double press = std::max(press_, kHoverForce);
    const glm::dvec3 stretch = felt_.proxy - felt_.hip;
    const double length = glm::length(stretch);
    if (!felt_.touching || !(length > 0.0)) {
        const glm::dvec3 way = position_ - from;
        const double most = press / std::max(goal.stiffness, goal.stiffest), gone = glm::length(way);
        if (goal.press > 0.0 && gone > most) {
            position_ = from + most / gone * way;
            velocity_ *= most / gone;
        }
        return;
    }
    const glm::dvec3 n = normalPart(stretch, felt_.planes);
    const double along = glm::dot(felt_.force, n);
    const double stiffness = std::max(goal.stiffness, glm::length(felt_.force) / length);
    glm::dvec3 across = felt_.force - along * n;
    double tangential = glm::length(across);
    const glm::dvec3 way = position_ - felt_.hip;
    across -= stiffness * (way - glm::dot(way, n) * n);
    const double held = press * std::sin(std::atan(goal.friction));
    tangential = std::max(tangential, std::min(goal.grip * glm::length(across), held));
    const double most = std::sqrt(std::max(0.0, press * press - tangential * tangential));
    const double deepest = glm::dot(stretch, n) + (most - along) / stiffness;
    const double excess = glm::dot(felt_.proxy - position_, n) - deepest;
    if (!(excess > 0.0))
        return;
    position_ += excess * n;
    velocity_ -= std::min(0.0, glm::dot(velocity_, n)) * n;
}

} // namespace touchstone
