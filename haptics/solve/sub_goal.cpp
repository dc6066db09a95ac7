#include "haptics/solve/sub_goal.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kMaxExchanges = 48;
/// Planes whose normals differ by less (rad, or the sine of the third to the plane of the other two) are one
/// plane. A move of the object's own length along one of them then violates the other by less than the
/// tolerance.
constexpr double kDependent = 3e-13;

const ConstraintPlane& at(std::span<const ConstraintPlane> planes, int index) {
    return planes[static_cast<size_t>(index)];
}

/// Nearest point to the goal on the intersection of `count` planes with its Lagrange multipliers; false if
/// dependent. By orthogonalisation: each plane is satisfied along a direction that leaves the earlier ones
/// unchanged, so that planes a millionth of a degree apart lose digits along their common line, where nothing
/// is decided, and not across it.
bool meet(const glm::dvec3& goal, std::span<const ConstraintPlane> planes, const std::array<int, 3>& set,
          int count, SubGoal& result) {
    const glm::dvec3& n0 = at(planes, set[0]).normal;
    const double a = at(planes, set[0]).offset - glm::dot(n0, goal);
    result.active = set;
    result.count = count;
    result.point = goal + a * n0;
    result.multiplier = {a, 0.0, 0.0};
    if (count == 1)
        return true;

    const glm::dvec3& n1 = at(planes, set[1]).normal;
    const double c1 = glm::dot(n1, n0);
    glm::dvec3 t = n1 - c1 * n0;
    t -= glm::dot(t, n0) * n0; // again: the first pass leaves rounding of n1 - n0 behind
    const double s1 = glm::length(t);
    if (s1 < kDependent)
        return false;
    t /= s1;
    const double b = (at(planes, set[1]).offset - glm::dot(n1, result.point)) / s1;
    result.point += b * t;
    result.multiplier = {a - b * c1 / s1, b / s1, 0.0};
    if (count == 2)
        return true;

    const glm::dvec3& n2 = at(planes, set[2]).normal;
    const glm::dvec3 u = glm::cross(n0, t);
    const double e2 = glm::dot(n2, u);
    if (std::abs(e2) < kDependent)
        return false;
    const double c = (at(planes, set[2]).offset - glm::dot(n2, result.point)) / e2;
    result.point += c * u;
    const double m2 = c / e2;
    const double m1 = (b - m2 * glm::dot(n2, t)) / s1;
    result.multiplier = {a - m1 * c1 - m2 * glm::dot(n2, n0), m1, m2};
    return true;
}

/// The nearest point among the intersections of `entering` with the subsets of `held` that violate no held
/// plane. For a convex problem that is the one without a negative multiplier (Karush-Kuhn-Tucker); selecting
/// by distance instead of by sign is immune to rounding where two candidates coincide.
bool exchange(const glm::dvec3& goal, std::span<const ConstraintPlane> planes, const SubGoal& held,
              int entering, double tolerance, SubGoal& result) {
    double nearest = INFINITY;
    const auto consider = [&](const std::array<int, 3>& set, int count) {
        SubGoal trial;
        if (!meet(goal, planes, set, count, trial))
            return;
        const glm::dvec3 away = trial.point - goal;
        const double distance = glm::dot(away, away);
        if (distance >= nearest)
            return;
        for (int i = 0; i < held.count; ++i) {
            const int other = held.active[static_cast<size_t>(i)];
            if (other == set[1] || (count == 3 && other == set[2]))
                continue;
            if (glm::dot(at(planes, other).normal, trial.point) < at(planes, other).offset - tolerance)
                return;
        }
        nearest = distance;
        result = trial;
    };
    const auto& active = held.active;
    consider({entering, -1, -1}, 1);
    for (size_t i = 0; i < static_cast<size_t>(held.count); ++i)
        consider({entering, active[i], -1}, 2);
    for (size_t i = 0; i < static_cast<size_t>(held.count); ++i)
        for (size_t k = i + 1; k < static_cast<size_t>(held.count); ++k)
            consider({entering, active[i], active[k]}, 3);
    for (double& multiplier : result.multiplier)
        multiplier = std::max(multiplier, 0.0);
    return nearest < INFINITY;
}

} // namespace

SubGoal detail::nearestToGoal(const glm::dvec3& goal, std::span<const ConstraintPlane> planes) noexcept {
    SubGoal current;
    current.point = goal;
    const double tolerance = detail::kPlaneTolerance * (1.0 + glm::length(goal));
    for (int step = 0; step < kMaxExchanges; ++step) {
        int worst = -1;
        double deepest = -tolerance;
        for (size_t i = 0; i < planes.size(); ++i) {
            const double slack = glm::dot(planes[i].normal, current.point) - planes[i].offset;
            if (slack < deepest) {
                deepest = slack;
                worst = static_cast<int>(i);
            }
        }
        if (worst < 0)
            return current;
        SubGoal next;
        if (!exchange(goal, planes, current, worst, tolerance, next))
            break;
        current = next;
    }
    SubGoal stay;
    stay.exact = false;
    return stay;
}

} // namespace touchstone
