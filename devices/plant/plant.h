#pragma once
// Mechanics of a device in a hand, in continuous time under a held force.

#include "devices/plant/plant_parameters.h"

#include <glm/glm.hpp>

namespace touchstone {

/// A point mass with viscous and Coulomb friction against the ground. A spring and a damper couple it to the
/// point that the hand intends; the mass of the hand is added:
///
///   (m + mh) x'' = F - b x' - fc x'/|x'| - kh (x - xh) - bh (x' - xh')
///
/// F is held and xh moves at a constant speed during `advance`, so that without Coulomb friction the step is
/// the matrix exponential, exact for any length. Coulomb friction is split off symmetrically over sub-steps
/// of at most kLongestSubStep (error of second order in them): each part alone is exact and neither adds
/// energy. A mass that friction brings to rest has velocity exactly 0 and stays exactly in place until the
/// pull exceeds fc: no creep, no chatter. No clock, no allocation. One thread.
class Plant {
  public:
    /// s. With 50 µs a light device at 1 m/s and 0.04 N stops within a nanometre of its closed form.
    static constexpr double kLongestSubStep = 5e-5;

    /// Throws Error where a parameter is outside its range.
    explicit Plant(const PlantParameters& parameters);

    /// At `position` (m) with `velocity` (m/s); resets the energy accounts.
    void place(const glm::dvec3& position, const glm::dvec3& velocity) noexcept;
    /// Advances by `dt` s (> 0) under `force` (N; motors saturate at maxForce), while the intention moves
    /// straight from `from` to `to` (m).
    void advance(double dt, const glm::dvec3& force, const glm::dvec3& from, const glm::dvec3& to) noexcept;

    [[nodiscard]] const glm::dvec3& position() const { return position_; } ///< m, before the sensor
    [[nodiscard]] const glm::dvec3& velocity() const { return velocity_; } ///< m/s
    [[nodiscard]] glm::dvec3 measured() const noexcept;  ///< m, rounded to the resolution of the sensor
    [[nodiscard]] double kineticEnergy() const noexcept; ///< J, with the mass of the hand
    /// J that the motors supplied since `place`: negative where the motion worked against them.
    [[nodiscard]] double motorWork() const { return motorWork_; }
    /// J that Coulomb friction dissipated since `place`: never negative.
    [[nodiscard]] double coulombLoss() const { return coulombLoss_; }
    [[nodiscard]] const PlantParameters& parameters() const { return parameters_; }

  private:
    /// x and v at the end of a sub-step of `length` s, from those at its start (e = x - xh) under a constant
    /// force f: e' = ee e + ev v + ef f, v' = ve e + vv v + vf f.
    struct Flow {
        double length = 0.0;
        double ee = 1.0, ev = 0.0, ef = 0.0, ve = 0.0, vv = 1.0, vf = 0.0;
    };
    void prepareFlow(double length) noexcept;
    /// Takes at most `impulse` (N·s) from the momentum.
    void brake(double impulse) noexcept;
    void flow(const glm::dvec3& force, const glm::dvec3& target, const glm::dvec3& targetVelocity) noexcept;
    void subStep(const glm::dvec3& force, const glm::dvec3& target,
                 const glm::dvec3& targetVelocity) noexcept;

    PlantParameters parameters_;
    double mass_; ///< kg, with the hand
    Flow flow_;
    glm::dvec3 position_{0.0}, velocity_{0.0};
    double motorWork_ = 0.0, coulombLoss_ = 0.0;
};

} // namespace touchstone
