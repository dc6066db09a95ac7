#include "haptics/body/hold_body.h"

#include <algorithm>
#include <cmath>

namespace touchstone::body {

namespace {

constexpr double kRatio = 0.7;
constexpr double kMaxDamping = 5.0; // N s/m
constexpr double kTurnRate = 300.0; // rad/s: of the orientation's return
constexpr double kArm = 0.05;       // m: the torque is at most the device's force at this arm

/// The rotation vector of a small or large turn, rad.
glm::dvec3 turnOf(glm::dquat q) {
    if (q.w < 0.0)
        q = -q;
    const glm::dvec3 axis(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    return sine > 0.0 ? 2.0 * std::atan2(sine, q.w) / sine * axis : glm::dvec3(0.0);
}

glm::dvec3 limited(const glm::dvec3& v, double most) {
    const double length = glm::length(v);
    return length > most ? most / length * v : v;
}

} // namespace

bool canHold(const BodyWorld& bodies, int object) noexcept {
    const int body = bodies.bodyOf(object);
    return body >= 0 && bodies.masses()[static_cast<size_t>(body)].inverse > 0.0;
}

Hold holdBody(BodyWorld& bodies, ObjectMotions motions, const Grasp& grasp, const glm::dvec3& hip,
              const glm::dvec3& velocity, double stiffness, const DeviceLimits& limits, double dt) noexcept {
    const auto b = static_cast<size_t>(bodies.bodyOf(grasp.object));
    const BodyMass& mass = bodies.masses()[b];
    const BodyState& state = bodies.states()[b];
    const Similarity& pose = motions[static_cast<size_t>(grasp.object)].workspaceFromObject;
    Hold hold{.place = pose.point(grasp.place)};

    const glm::dvec3 moves = state.velocity + glm::cross(state.spin, hold.place - state.pose.position);
    const double damping = std::min(
        {2.0 * kRatio * std::sqrt(stiffness / mass.inverse), 0.2 / (mass.inverse * dt), kMaxDamping});
    hold.force = limited(stiffness * (hold.place - hip) + damping * (moves - velocity), limits.maxForce);
    // Its damper is in the force: the spring alone would not be at the step's end.
    bodies.push(grasp.object, {.point = hold.place,
                               .force = -hold.force,
                               .velocity = moves,
                               .stiffness = stiffness,
                               .most = limits.maxForce});

    const glm::dvec3 back = turnOf(grasp.rotation * glm::conjugate(pose.rotation));
    const glm::dvec3 wanted = kTurnRate * kTurnRate * back - 2.0 * kRatio * kTurnRate * state.spin;
    const glm::dquat& axes = state.pose.rotation;
    const glm::dvec3 torque = axes * (mass.inertia * (glm::conjugate(axes) * wanted));
    bodies.turn(grasp.object, limited(torque, kArm * limits.maxForce));
    return hold;
}

} // namespace touchstone::body
