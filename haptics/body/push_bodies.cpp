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
// step; |F| alone in place of the numerator, the hand at rest, lost 1.2 to 2 % of it. (One common factor of a
// sum of forces that cancel turned a squeezed body without bound.)
//
// Where several hands push one body, v' is its velocity after all of them. Their springs are a system whose
// matrix is symmetric and positive definite, with f >= 0: projected Gauss-Seidel, hand after hand, as for
// contacts. After a single round each hand but the last has v' before the pushes after its own, and its force
// differs from what it feels next by about dt^2 k / m of theirs.

#include "haptics/body/body_world.h"

#include <algorithm>
#include <cmath>

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

namespace {

constexpr int kRounds = 12;
constexpr double kSolved = 1e-9; // of a hand's force: the change at which the rounds end

} // namespace

/// Pushes with the force at the end of the step in place of what the round before has found. Returns the
/// change over the force at the step's beginning; 0 where the push is no implicit one.
double BodyWorld::solvePush(Push& push, BodyIntegrator integrator, double dt) noexcept {
    const auto b = static_cast<size_t>(push.body);
    const HandPush& hand = push.hand;
    const double size = glm::length(hand.force);
    const BodyMass& mass = masses_[b];
    BodyState& state = states_[b];
    if (!state.awake || !(size > 0.0))
        return 0.0;
    const glm::dvec3 along = hand.force / size, lever = hand.point - state.pose.position;
    const glm::dvec3 arm = glm::cross(lever, along), turns = turned(mass, state.pose.rotation, arm);
    const double rate = dt * dt * hand.stiffness * (mass.inverse + glm::dot(arm, turns));
    // A body so light that the spring's rate is beyond the step's is never pushed by all of it but by Euler.
    const bool atEnd =
        integrator == BodyIntegrator::Implicit || (integrator == BodyIntegrator::SemiImplicit && rate > 1.0);
    double exerted = size;
    if (atEnd) {
        const glm::dvec3 moves = state.velocity + glm::cross(state.spin, lever);
        const double end = size + dt * hand.stiffness * glm::dot(hand.velocity - moves, along);
        // 0: the hand and the body part within the step.
        exerted =
            std::clamp(push.exerted + (end - push.exerted) / (1.0 + rate), 0.0, std::max(hand.most, size));
    }
    const double more = exerted - push.exerted;
    state.velocity += dt * mass.inverse * more * along;
    state.spin += dt * more * turns;
    push.exerted = exerted;
    return atEnd ? std::abs(more) / size : 0.0;
}

void BodyWorld::applyPushes(BodyIntegrator integrator, double dt) noexcept {
    for (const Push& push : pushes_) {
        const auto b = static_cast<size_t>(push.body);
        BodyState& state = states_[b];
        if (!state.awake)
            continue;
        state.spin += dt * turned(masses_[b], state.pose.rotation, push.torque);
        state.quiet = 0.0;
    }
    double change = 1.0;
    for (int round = 0; round < kRounds && change > kSolved; ++round) {
        change = 0.0;
        for (Push& push : pushes_)
            change = std::max(change, solvePush(push, integrator, dt));
    }
    pushes_.clear();
}

} // namespace touchstone::body
