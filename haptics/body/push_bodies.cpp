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
//
// A device bears no more than its greatest force, and the spring may be deeper than that: f begins at the
// spring's force, and is cut off at what the device exerts. (With the cut force in place of the spring's, a
// body that gave way lost 1 to 2 % of what the hand gave.)

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

/// What of a push stays the same in its step.
void BodyWorld::measurePush(Push& push, double dt) const noexcept {
    const auto b = static_cast<size_t>(push.body);
    const double size = glm::length(push.hand.force);
    if (!(size > 0.0))
        return;
    push.along = push.hand.force / size;
    push.lever = push.hand.point - states_[b].pose.position;
    const glm::dvec3 arm = glm::cross(push.lever, push.along);
    push.turns = turned(masses_[b], states_[b].pose.rotation, arm);
    push.rate = dt * dt * push.hand.stiffness * (masses_[b].inverse + glm::dot(arm, push.turns));
}

/// Pushes with the force at the end of the step in place of what the round before has found. Returns the
/// change over the force at the step's beginning; 0 where the push is no implicit one.
double BodyWorld::solvePush(Push& push, double dt) noexcept {
    const auto b = static_cast<size_t>(push.body);
    const HandPush& hand = push.hand;
    const double size = glm::length(hand.force);
    BodyState& state = states_[b];
    if (!state.awake || !(size > 0.0))
        return 0.0;
    double exerted = size;
    if (push.atEnd) {
        const glm::dvec3 moves = state.velocity + glm::cross(state.spin, push.lever);
        const double end =
            hand.wanted * size + dt * hand.stiffness * glm::dot(hand.velocity - moves, push.along);
        // 0: the hand and the body part within the step. A force that the device cuts off, of all parts of
        // the hand together, grows in none of them.
        const double most = hand.wanted > 1.0 ? size : std::max(hand.most, size);
        exerted = std::clamp(push.exerted + (end - push.exerted) / (1.0 + push.rate), 0.0, most);
    }
    const double more = exerted - push.exerted;
    state.velocity += dt * masses_[b].inverse * more * push.along;
    state.spin += dt * more * push.turns;
    push.exerted = exerted;
    return push.atEnd ? std::abs(more) / size : 0.0;
}

void BodyWorld::applyPushes(BodyIntegrator integrator, double dt) noexcept {
    for (Push& push : pushes_) {
        const auto b = static_cast<size_t>(push.body);
        BodyState& state = states_[b];
        measurePush(push, dt);
        if (!state.awake)
            continue;
        state.spin += dt * turned(masses_[b], state.pose.rotation, push.torque);
        state.quiet = 0.0;
    }
    // Springs beyond the step's rate, of all hands on a body, never push it with all of their force but by
    // Euler.
    for (Push& push : pushes_) {
        double rates = 0.0;
        for (const Push& other : pushes_)
            rates += other.body == push.body ? other.rate : 0.0;
        push.atEnd = integrator == BodyIntegrator::Implicit ||
                     (integrator == BodyIntegrator::SemiImplicit && rates > 1.0);
    }
    double change = 1.0;
    for (int round = 0; round < kRounds && change > kSolved; ++round) {
        change = 0.0;
        for (Push& push : pushes_)
            change = std::max(change, solvePush(push, dt));
    }
    pushes_.clear();
}

} // namespace touchstone::body
