#include "devices/plant/plant.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 product(const Matrix3& a, const Matrix3& b) noexcept {
    Matrix3 c{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            for (size_t k = 0; k < 3; ++k)
                c[i][j] += a[i][k] * b[k][j];
    return c;
}

/// exp(a) by scaling and squaring: 12 terms of Taylor's series at a norm of at most 1/16 leave 1e-25.
Matrix3 exponential(Matrix3 a) noexcept {
    double norm = 0.0;
    for (const auto& row : a)
        norm = std::max(norm, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
    const int squarings = norm > 0.0625 ? static_cast<int>(std::ceil(std::log2(norm / 0.0625))) : 0;
    for (auto& row : a)
        for (double& value : row)
            value = std::ldexp(value, -squarings);
    constexpr Matrix3 kOne{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Matrix3 sum = kOne;
    for (int term = 12; term >= 1; --term) { // Horner: 1 + a (1 + a/2 (1 + ...))
        sum = product(a, sum);
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j)
                sum[i][j] = kOne[i][j] + sum[i][j] / term;
    }
    for (int i = 0; i < squarings; ++i)
        sum = product(sum, sum);
    return sum;
}

} // namespace

Plant::Plant(const PlantParameters& parameters)
    : parameters_(parameters), mass_(parameters.mass + parameters.handMass) {
    checkPlant(parameters);
}

void Plant::place(const glm::dvec3& position, const glm::dvec3& velocity) noexcept {
    position_ = position;
    velocity_ = velocity;
    motorWork_ = coulombLoss_ = 0.0;
}

/// The force is a third, constant state; velocities are in m per sub-step, so that the scales agree.
void Plant::prepareFlow(double length) noexcept {
    if (std::abs(flow_.length - length) <= 1e-9 * length) // differences of one clock, up to rounding
        return;
    const double h = length;
    const double damping = parameters_.viscousFriction + parameters_.handDamping;
    const Matrix3 step =
        exponential({{{0, 1, 0},
                      {-parameters_.handStiffness * h * h / mass_, -damping * h / mass_, h * h / mass_},
                      {0, 0, 0}}});
    flow_ = {h, step[0][0], step[0][1] * h, step[0][2], step[1][0] / h, step[1][1], step[1][2] / h};
}

void Plant::brake(double impulse) noexcept {
    const double speed = glm::length(velocity_);
    if (speed <= 0.0)
        return;
    const double left = std::max(0.0, speed - impulse / mass_);
    coulombLoss_ += 0.5 * mass_ * (speed - left) * (speed + left);
    velocity_ = left > 0.0 ? velocity_ * (left / speed) : glm::dvec3(0.0);
}

/// In the frame of the hand's point, which moves at a constant velocity w, the ground's viscous friction adds
/// the force b w.
void Plant::flow(const glm::dvec3& force, const glm::dvec3& target,
                 const glm::dvec3& targetVelocity) noexcept {
    const glm::dvec3 f = force - parameters_.viscousFriction * targetVelocity;
    const glm::dvec3 e = position_ - target, v = velocity_ - targetVelocity;
    const glm::dvec3 moved = target + flow_.length * targetVelocity;
    position_ = moved + flow_.ee * e + flow_.ev * v + flow_.ef * f;
    velocity_ = targetVelocity + flow_.ve * e + flow_.vv * v + flow_.vf * f;
}

void Plant::subStep(const glm::dvec3& force, const glm::dvec3& target,
                    const glm::dvec3& targetVelocity) noexcept {
    const double friction = parameters_.coulombFriction;
    if (friction <= 0.0) {
        flow(force, target, targetVelocity);
        return;
    }
    const double half = 0.5 * flow_.length * friction;
    if (glm::length(velocity_) * mass_ > half) {
        brake(half);
        flow(force, target, targetVelocity);
        brake(half);
        return;
    }
    // Slower than half a brake impulse: the mass sticks, or is about to break away, and the direction of
    // friction is known.
    const glm::dvec3 pull =
        force - parameters_.handStiffness * (position_ - target) + parameters_.handDamping * targetVelocity;
    const double strength = glm::length(pull);
    if (strength <= friction || glm::dot(velocity_, pull) <= 0.0)
        brake(half);
    if (strength <= friction)
        return;
    const glm::dvec3 from = position_, against = -(friction / strength) * pull;
    flow(force + against, target, targetVelocity);
    coulombLoss_ -= glm::dot(against, position_ - from);
}

void Plant::advance(double dt, const glm::dvec3& force, const glm::dvec3& from,
                    const glm::dvec3& to) noexcept {
    const double steps = parameters_.coulombFriction > 0.0
                             ? std::max(1.0, std::ceil(dt / kLongestSubStep * (1.0 - 1e-9)))
                             : 1.0;
    prepareFlow(dt / steps);
    const double strength = glm::length(force);
    const glm::dvec3 saturated =
        strength > parameters_.maxForce ? force * (parameters_.maxForce / strength) : force;
    const glm::dvec3 targetVelocity = (to - from) / dt, start = position_;
    for (double step = 0.0; step < steps; step += 1.0)
        subStep(saturated, from + (step * flow_.length) * targetVelocity, targetVelocity);
    motorWork_ += glm::dot(saturated, position_ - start);
}

glm::dvec3 Plant::measured() const noexcept {
    const double step = parameters_.resolution;
    return step > 0.0 ? step * glm::round(position_ / step) : position_;
}

double Plant::kineticEnergy() const noexcept {
    return 0.5 * mass_ * glm::dot(velocity_, velocity_);
}

} // namespace touchstone
