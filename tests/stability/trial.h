#pragma once
// The bench of the hard cases: a scene, every combination of radius and shading, and what is measured in each
// tick.

#include "tests/support/touch_bench.h"

#include <functional>
#include <string>
#include <vector>

namespace touchstone::test {

/// One way to run a case.
struct Variant {
    double radius = 0.0; ///< m
    bool shaded = false;
    [[nodiscard]] std::string name() const;
    [[nodiscard]] HapticSettings settings() const; ///< k = 1000 N/m, no friction, no texture
};
[[nodiscard]] std::vector<Variant> allVariants();     ///< r = 0 and 0.5 mm, flat and shaded
[[nodiscard]] const std::vector<double>& allSpeeds(); ///< 0.05, 1, 5 and 50 m/s

/// What a run measured. `energy` is the work done on the hand, J: positive over a closed path is energy
/// created.
struct Measured {
    int ticks = 0, contactTicks = 0, notFinite = 0, budgetReached = 0;
    double largestJump = 0.0; ///< N, force change in one tick beyond k times the HIP's motion
    double energy = 0.0;
};

/// Follows the runs of a bench.
class Gauge {
  public:
    explicit Gauge(double stiffness = 1000.0) : stiffness_(stiffness) {}
    void take(const HapticOutput& output);
    [[nodiscard]] const Measured& measured() const { return measured_; }
    /// Forgets the energy and the jumps, for a part of a run that is judged on its own.
    void restart() {
        measured_ = Measured{};
        first_ = true;
    }

  private:
    double stiffness_;
    Measured measured_;
    bool first_ = true;
    glm::dvec3 lastHip_{0.0}, lastForce_{0.0};
};

/// A shape from corner coordinates: three per triangle, flat.
[[nodiscard]] assets::Shape soup(const std::vector<glm::dvec3>& corners);
/// Appends the quad a b c d (counter-clockwise) as two triangles.
void addQuad(std::vector<glm::dvec3>& corners, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
             const glm::dvec3& d);
/// Joins shapes into one; vertices are not shared between them.
void append(assets::Shape& shape, const assets::Shape& other, const glm::dmat4& at = glm::dmat4(1.0));

/// Holds the HIP still for `ticks` and returns the largest change of the force from one tick to the next, N.
[[nodiscard]] double holdStill(TouchBench& bench, int ticks);

} // namespace touchstone::test
