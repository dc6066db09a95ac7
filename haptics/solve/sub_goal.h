#pragma once

#include <glm/glm.hpp>

#include <array>
#include <span>

namespace touchstone {

/// Half-space normal · x >= offset. In the proxy solve x is relative to the proxy, which satisfies every
/// plane.
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

namespace detail {

/// A plane is violated beyond this fraction of 1 + |goal|.
inline constexpr double kPlaneTolerance = 3e-14;

/// Any number of planes.
[[nodiscard]] SubGoal nearestToGoal(const glm::dvec3& goal, std::span<const ConstraintPlane> planes) noexcept;

} // namespace detail

/// Nearest point to `goal` in the intersection of the half-spaces, of which at most three are active: faces,
/// edges and corners by one rule [000 §3, 001]. Planes whose normals differ by less than 3e-13 rad count as
/// one. Bounded: at most 48 planes enter. In most ticks there is one plane, and nothing to exchange.
[[nodiscard]] inline SubGoal nearestFeasible(const glm::dvec3& goal,
                                             std::span<const ConstraintPlane> planes) noexcept {
    if (planes.size() != 1)
        return detail::nearestToGoal(goal, planes);
    SubGoal result;
    result.point = goal;
    const double lack = planes[0].offset - glm::dot(planes[0].normal, goal);
    if (lack > detail::kPlaneTolerance * (1.0 + glm::length(goal))) {
        result.point += lack * planes[0].normal;
        result.multiplier[0] = lack;
        result.count = 1;
    }
    return result;
}

} // namespace touchstone
