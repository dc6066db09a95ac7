// The hands' forces on bodies.
//
// A hand feels its force F at the beginning of a step, that of a spring k between hand and body. With u along
// F, the spring at the end of the step of dt exerts
//
//     f = |F| + dt k u.(v_hand - v'),   v' = v + f dt (1/m + a.I^-1 a) u,   a = lever x u,
//
// v and v' the velocities of the body's touched point before and after. So
//
//     f = (|F| + dt k u.(v_hand - v)) / (1 + dt^2 k (1/m + a.I^-1 a)).
//
// That is what the hand feels in the next step, so that the body's momentum is the hand's impulse but for one
// step; |F| alone in place of the numerator, the hand at rest, lost 1.2 to 2 % of it. Each push is solved
// after those before it: two hands that hold a light body are two springs, and neither gets the other's
// torque (one common factor of a sum of forces that cancel turned the body without bound).

#include "haptics/body/body_world.h"

#include <algorithm>

namespace touchstone::body {

/// Wakes a body that can be pushed.
bool BodyWorld::takes(int body) noexcept {
    if (body < 0 || masses_[static_cast<size_t>(body)].inverse == 0.0 || pushes_.size() == kMaxPushes)
        return false;
    wake(body);
    return true;
}

void BodyWorld::push(int object, const HandPush& push) noexcept {
    const int body = bodyOf(object);
    if (push.force != glm::dvec3(0.0) && takes(body))
        pushes_.push_back({.body = body, .hand = push});
}

void BodyWorld::turn(int object, const glm::dvec3& torque) noexcept {
    const int body = bodyOf(object);
    if (torque != glm::dvec3(0.0) && takes(body))
        pushes_.push_back({.body = body, .hand = {}, .torque = torque});
}

/// The force at the end of the step over that at its beginning, for the implicit integrator, and where a body
/// is so light that the spring's rate is beyond the step's. 0: the hand and the body part within the step.
double BodyWorld::partOf(const Push& push, BodyIntegrator integrator, double dt) const noexcept {
    const auto b = static_cast<size_t>(push.body);
    const HandPush& hand = push.hand;
    const double size = glm::length(hand.force);
    if (integrator == BodyIntegrator::Explicit || !(size > 0.0))
        return 1.0;
    const BodyMass& mass = masses_[b];
    const BodyState& state = states_[b];
    const glm::dvec3 along = hand.force / size, lever = hand.point - state.pose.position;
    const glm::dvec3 arm = glm::cross(lever, along);
    const double rate =
        dt * dt * hand.stiffness * (mass.inverse + glm::dot(arm, turned(mass, state.pose.rotation, arm)));
    if (integrator == BodyIntegrator::SemiImplicit && rate <= 1.0)
        return 1.0;
    const glm::dvec3 moves = state.velocity + glm::cross(state.spin, lever);
    const double end = (size + dt * hand.stiffness * glm::dot(hand.velocity - moves, along)) / (1.0 + rate);
    return std::clamp(end, 0.0, std::max(hand.most, size)) / size;
}

void BodyWorld::applyPushes(BodyIntegrator integrator, double dt) noexcept {
    for (const Push& push : pushes_) {
        const auto b = static_cast<size_t>(push.body);
        const BodyMass& mass = masses_[b];
        BodyState& state = states_[b];
        if (!state.awake)
            continue;
        const double part = partOf(push, integrator, dt);
        const glm::dvec3 torque =
            part * glm::cross(push.hand.point - state.pose.position, push.hand.force) + push.torque;
        state.velocity += part * dt * mass.inverse * push.hand.force;
        state.spin += dt * turned(mass, state.pose.rotation, torque);
        state.quiet = 0.0;
    }
    pushes_.clear();
}

} // namespace touchstone::body
