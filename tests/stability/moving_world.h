#pragma once
// Boxes that move as a test tells them, and the truth about each tick: in long double, against every
// triangle.

#include "tests/stability/trial.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace touchstone::test {

/// A turn about an axis and then a translation, for boxes whose meshes are centred on the origin.
[[nodiscard]] Similarity posed(const glm::dvec3& at, double angle = 0.0, const glm::dvec3& axis = {0, 0, 1});

/// Closed boxes, each an object. Every step fails the test where the proxy is nearer than its radius to a box
/// that is not jammed, where anything is not finite or anything was allocated.
class MovingWorld {
  public:
    struct Box {
        glm::dvec3 sides; ///< m
        Similarity pose;  ///< `posed`, then changed by the test between steps
        bool jumped = false;
    };
    MovingWorld(const Variant& variant, std::vector<Box> boxes, int cells = 1);

    const HapticOutput& step(const glm::dvec3& hip);
    /// Clearance of the proxy's centre from box k, m; negative inside.
    [[nodiscard]] double clearance(size_t k) const;
    [[nodiscard]] bool jammed() const { return has(bench.output.flags, TickFlag::Jammed); }

    std::vector<Box> boxes;
    TouchBench bench;
    double radius;            ///< m
    double largestStep = 0.0; ///< N, greatest change of the force in one tick since it was last set to zero
    int pinchedTicks = 0, ticks = 0, contactTicks = 0;

  private:
    std::vector<double> unitSize_;
    glm::dvec3 lastForce_{0.0};
};

} // namespace touchstone::test
