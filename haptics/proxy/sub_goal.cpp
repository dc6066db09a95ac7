#include "haptics/proxy/sub_goal.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kMaxExchanges = 48;
/// Squared sine below which two planes, or cosine-determinant below which three, count as dependent.
constexpr double kDependent = 1e-14;

/// Nearest point to the goal on the meet of `count` planes with its Lagrange multipliers; false if dependent.
bool meet(const glm::dvec3& goal, std::span<const ConstraintPlane> planes, const std::array<int, 3>& set,
          int count, SubGoal& result) {
    const auto plane = [&](int i) -> const ConstraintPlane& {
        return planes[static_cast<size_t>(set[static_cast<size_t>(i)])];
    };
    // Lack of each plane at the goal; the multipliers solve Gram * multiplier = lack.
    const auto lack = [&](int i) { return plane(i).offset - glm::dot(plane(i).normal, goal); };
    result.active = set;
    result.count = count;
    if (count == 1) {
        result.multiplier = {lack(0), 0.0, 0.0};
    } else if (count == 2) {
        const double c = glm::dot(plane(0).normal, plane(1).normal);
        const glm::dvec3 line = glm::cross(plane(0).normal, plane(1).normal);
        const double det = glm::dot(line, line); // 1 - c^2 without its cancellation
        if (det < kDependent)
            return false;
        const double l0 = lack(0), l1 = lack(1);
        result.multiplier = {(l0 - c * l1) / det, (l1 - c * l0) / det, 0.0};
    } else {
        const glm::dvec3 &n0 = plane(0).normal, &n1 = plane(1).normal, &n2 = plane(2).normal;
        const double det = glm::dot(n0, glm::cross(n1, n2));
        if (det * det < kDependent * kDependent)
            return false;
        const glm::dvec3 r0 = glm::cross(n1, n2) / det, r1 = glm::cross(n2, n0) / det,
                         r2 = glm::cross(n0, n1) / det;
        // The corner x solves N x = offset; x - goal = N^T multiplier.
        const glm::dvec3 step = lack(0) * r0 + lack(1) * r1 + lack(2) * r2;
        result.multiplier = {glm::dot(step, r0), glm::dot(step, r1), glm::dot(step, r2)};
    }
    result.point = goal;
    for (int i = 0; i < count; ++i)
        result.point += result.multiplier[static_cast<size_t>(i)] * plane(i).normal;
    return true;
}

/// Tries the subsets of `held` together with `entering`, small ones first. Exactly one subset has no negative
/// multiplier and violates none of the others (Karush-Kuhn-Tucker for a convex problem).
bool exchange(const glm::dvec3& goal, std::span<const ConstraintPlane> planes, const SubGoal& held,
              int entering, double tolerance, SubGoal& result) {
    const auto accepted = [&](const std::array<int, 3>& set, int count) {
        SubGoal trial;
        if (!meet(goal, planes, set, count, trial))
            return false;
        for (int i = 0; i < count; ++i)
            if (trial.multiplier[static_cast<size_t>(i)] < 0.0)
                return false;
        for (int i = 0; i < held.count; ++i) {
            const ConstraintPlane& other = planes[static_cast<size_t>(held.active[static_cast<size_t>(i)])];
            if (glm::dot(other.normal, trial.point) < other.offset - tolerance)
                return false;
        }
        result = trial;
        return true;
    };
    if (accepted({entering, 0, 0}, 1))
        return true;
    for (int i = 0; i < held.count; ++i)
        if (accepted({entering, held.active[static_cast<size_t>(i)], 0}, 2))
            return true;
    for (int i = 0; i < held.count; ++i)
        for (int k = i + 1; k < held.count; ++k)
            if (accepted({entering, held.active[static_cast<size_t>(i)], held.active[static_cast<size_t>(k)]},
                         3))
                return true;
    return false;
}

} // namespace

SubGoal nearestFeasible(const glm::dvec3& goal, std::span<const ConstraintPlane> planes) noexcept {
    SubGoal current;
    current.point = goal;
    const double tolerance = 1e-14 * (1.0 + glm::length(goal));
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
