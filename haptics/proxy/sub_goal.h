#pragma once

#include <glm/glm.hpp>

#include <array>
#include <span>

namespace touchstone {

/// Half-space normal · x >= offset. In the proxy solve x counts from the proxy, which satisfies every plane.
struct ConstraintPlane {
    glm::dvec3 normal{0.0}; ///< unit, out of the surface
    double offset = 0.0;    ///< <= 0 where the origin is feasible
};

/// The feasible point nearest to a goal, with the planes that hold it there.
struct SubGoal {
    glm::dvec3 point{0.0};
    std::array<int, 3> active{};        ///< indices into the planes
    std::array<double, 3> multiplier{}; ///< >= 0: point = goal + sum multiplier_i normal_i
    int count = 0;
    bool exact = true; ///< false: numerically degenerate, `point` is the origin
};

/// Nearest point to `goal` in the intersection of the half-spaces, of which at most three are active: faces,
/// edges and corners by one rule [000 §3, 001]. Planes whose normals differ by less than 3e-13 rad count as
/// one. Bounded: at most kMaxExchanges planes enter.
[[nodiscard]] SubGoal nearestFeasible(const glm::dvec3& goal,
                                      std::span<const ConstraintPlane> planes) noexcept;

} // namespace touchstone
