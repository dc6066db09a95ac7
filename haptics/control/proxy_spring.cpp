#include "haptics/control/proxy_spring.h"

#include "haptics/sample/hip_sample.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace touchstone {

namespace {

constexpr double kFarthest = 1e3;       // m: beyond it a proxy is a fault of its sender
constexpr double kMostStiffness = 1e7;  // N/m
constexpr double kMostDamping = 1e4;    // N s/m
constexpr double kUnitTolerance = 1e-3; // of a normal that went through a text

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double squared(const glm::dvec3& v) {
    return glm::dot(v, v);
}

/// The last point of the way from `from` to `to` that is within the square root of `most` of `hand`, as
/// `from` is and `to` is not: |from + s w - hand|^2 is convex in s, so that it meets `most` once.
glm::dvec3 lastWithin(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& hand, double most) {
    const glm::dvec3 way = to - from, behind = from - hand;
    const double a = squared(way), b = glm::dot(behind, way), c = squared(behind) - most; // c <= 0
    if (!(a > 0.0))
        return from;
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    // The larger root of a s^2 + 2 b s + c, without cancellation.
    const double share = b > 0.0 ? (b + root > 0.0 ? -c / (b + root) : 0.0) : (root - b) / a;
    return from + std::clamp(share, 0.0, 1.0) * way;
}

/// J that a spring gives back through a device that pulls no harder than maxForce: it took no more.
double storedBy(double stiffness, double length, double maxForce) {
    const double force = stiffness * length;
    return force <= maxForce ? 0.5 * force * length : maxForce * (length - 0.5 * maxForce / stiffness);
}

} // namespace

const char* problemOf(const ContactGoal& goal) noexcept {
    if (!goal.touching)
        return nullptr;
    if (!finite(goal.proxy) || !(squared(goal.proxy) <= kFarthest * kFarthest))
        return "'proxy' is not within 1 km";
    if (!(goal.stiffness > 0.0 && goal.stiffness <= kMostStiffness))
        return "'stiffness' is not above 0 and within 1e7 N/m";
    if (!(goal.damping >= 0.0 && goal.damping <= kMostDamping))
        return "'damping' is not within 0 .. 1e4 N s/m";
    if (goal.planeCount > goal.planes.size())
        return "'planes' has more than 3 normals";
    for (size_t i = 0; i < goal.planeCount; ++i)
        if (!finite(goal.planes[i]) || !(std::abs(glm::length(goal.planes[i]) - 1.0) <= kUnitTolerance))
            return "'planes' has a normal that is no unit vector";
    return nullptr;
}

bool ProxySpring::hear(const ContactGoal& goal) noexcept {
    if (problemOf(goal) != nullptr)
        return false;
    goal_ = goal;
    silent_ = 0.0;
    return true;
}

void ProxySpring::forget(double power) noexcept {
    settings_.power = power;
    goal_ = ContactGoal{};
    silent_ = 0.0;
}

/// The hand's velocity, filtered as that of the haptic step; what the damper took on the way here is credit.
void ProxySpring::measure(const glm::dvec3& hand, double dt) noexcept {
    const glm::dvec3 way = placed_ ? hand - last_ : glm::dvec3(0.0);
    last_ = hand;
    if (!placed_ || !(dt > 0.0)) {
        placed_ = true;
        velocity_ = damping_ = glm::dvec3(0.0);
        return;
    }
    const double share = 1.0 - std::exp(-2.0 * std::numbers::pi * kVelocityCutoff * dt);
    velocity_ += share * (way / dt - velocity_);
    credit_ = std::clamp(credit_ - glm::dot(damping_, way), -kMostCredit, kMostCredit);
}

/// Between goals: along the planes, through where the end is, to the place nearest to the hand.
void ProxySpring::slide(const glm::dvec3& hand) noexcept {
    if (planeCount_ > 0)
        end_ += nearestFeasible(hand - end_, std::span(planes_.data(), planeCount_)).point;
}

void ProxySpring::takePlanes(const DeviceMapping& mapping) noexcept {
    planeCount_ = goal_.planeCount;
    for (size_t i = 0; i < planeCount_; ++i)
        planes_[i].normal =
            glm::normalize(glm::conjugate(mapping.workspaceFromDevice.rotation) * goal_.planes[i]);
}

/// 0..1: what silence has left of the spring.
double ProxySpring::left() const noexcept {
    return std::clamp(1.0 - (silent_ - settings_.silence) / kFadeTime, 0.0, 1.0);
}

void ProxySpring::moveEnd(const glm::dvec3& hand, const DeviceSample& sample, double dt) noexcept {
    const DeviceMapping& mapping = sample.mapping;
    if (!holds()) {
        end_ = hand;
        planeCount_ = 0;
        stiffness_ = 0.0;
        credit_ = 0.0;
        return;
    }
    slide(hand);
    const double stored = storedBy(stiffness_, glm::length(end_ - hand), sample.limits.maxForce);
    stiffness_ = left() * goal_.stiffness;
    const double half = 0.5 * stiffness_;
    takePlanes(mapping);
    const glm::dvec3 proxy = mapping.workspaceFromDevice.inversePoint(goal_.proxy);
    const glm::dvec3 place =
        planeCount_ > 0 ? proxy + nearestFeasible(hand - proxy, std::span(planes_.data(), planeCount_)).point
                        : proxy;
    const double allowed = std::max(0.0, credit_) + settings_.power * std::max(dt, 1e-9);
    // At the last instant of the fade the quotient is huge; the spring is not.
    const double most = (stored + allowed) / std::max(half, 1e-12), wanted = squared(place - hand);
    if (const double has = squared(end_ - hand); has > most) // a stiffer spring holds as much with less
        end_ = hand + std::sqrt(most / has) * (end_ - hand);
    if (wanted <= most)
        end_ = place;
    else if (planeCount_ > 0) // as deep as may be, without a pull along the planes
        end_ = hand + std::sqrt(most / wanted) * (place - hand);
    else
        end_ = lastWithin(end_, place, hand, most);
    if (const double risen = half * squared(end_ - hand) - stored; risen > 0.0) {
        const double lent = std::min(risen, std::max(0.0, credit_));
        credit_ -= lent;
        added_ += risen - lent;
    }
}

DeviceCommand ProxySpring::step(const DeviceSample& sample, double dt, bool forceEnabled,
                                bool late) noexcept {
    flags_ = 0;
    const bool known = sample.valid && finite(sample.position);
    silent_ += dt;
    force_ = glm::dvec3(0.0);
    if (known) {
        if (!placed_ || sample.begins)
            end_ = sample.position;
        measure(sample.position, dt);
        moveEnd(sample.position, sample, dt);
    } else {
        placed_ = false;
    }
    damping_ = glm::dvec3(0.0);
    if (known && holds() && end_ != sample.position) {
        damping_ = -left() * goal_.damping * velocity_;
        force_ = stiffness_ * (end_ - sample.position) + damping_;
    }
    const SafetyInputs inputs{.limits = sample.limits,
                              .dt = dt,
                              .inputValid = known,
                              .sampleAge = sample.age,
                              .forceEnabled = forceEnabled,
                              .late = late,
                              .passivity = settings_.passivity,
                              .position = sample.position,
                              .springLength = glm::length(end_ - sample.position),
                              .coupling = sample.mapping.coupling};
    const DeviceCommand command = ForceLimiter::limit(force_, glm::dvec3(0.0), inputs, {}, limiter_, flags_);
    // The damper takes no more than what reaches the hand: only that is credit.
    const double wanted = squared(force_);
    damping_ *= wanted > 0.0 ? std::clamp(glm::dot(command.force(), force_) / wanted, 0.0, 1.0) : 0.0;
    return command;
}

} // namespace touchstone
