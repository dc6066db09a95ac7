#pragma once
// The place nearest to a goal on at most four half-spaces, in the selected precision. The counterpart of
// sub_goal.h, which handles the sweep's many planes in double, for the few planes of a god-object of rays.

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace touchstone {

/// Half-space normal · x >= offset; x is relative to the god-object.
template <class Real>
struct FewPlane {
    glm::vec<3, Real> normal{Real(0)}; ///< unit
    Real offset = 0;
};

template <class Real>
struct FewPlanes {
    static constexpr size_t kMax = 4; ///< three that hold it and the newest one
    std::array<FewPlane<Real>, kMax> plane;
    size_t count = 0;
};

template <class Real>
struct FewPlanesGoal {
    glm::vec<3, Real> point{Real(0)};
    std::array<size_t, 3> active{};
    std::array<Real, 3> multiplier{}; ///< >= 0
    size_t count = 0;
    bool found = true; ///< false: contradictory planes; `point` is the origin
};

namespace detail {

/// The point of the intersection of `count` planes that is nearest to the goal, with its Lagrange multipliers
/// (Zilles and Salisbury's system of equations, by orthogonalisation). False where the planes are dependent.
template <class Real>
bool meetOf(const glm::vec<3, Real>& goal, const FewPlanes<Real>& planes, const std::array<size_t, 3>& set,
            size_t count, FewPlanesGoal<Real>& result) noexcept {
    using Vec = glm::vec<3, Real>;
    constexpr Real kDependent = 64 * std::numeric_limits<Real>::epsilon();
    result.active = set;
    result.count = count;
    const FewPlane<Real>& first = planes.plane[set[0]];
    const Real a = first.offset - glm::dot(first.normal, goal);
    result.point = goal + a * first.normal;
    result.multiplier = {a, 0, 0};
    if (count == 1)
        return true;
    const FewPlane<Real>& second = planes.plane[set[1]];
    const Real c1 = glm::dot(second.normal, first.normal);
    Vec t = second.normal - c1 * first.normal;
    t -= glm::dot(t, first.normal) * first.normal;
    const Real s1 = glm::length(t);
    if (!(s1 > kDependent))
        return false;
    t /= s1;
    const Real b = (second.offset - glm::dot(second.normal, result.point)) / s1;
    result.point += b * t;
    result.multiplier = {a - b * c1 / s1, b / s1, 0};
    if (count == 2)
        return true;
    const FewPlane<Real>& third = planes.plane[set[2]];
    const Vec u = glm::cross(first.normal, t);
    const Real e2 = glm::dot(third.normal, u);
    if (!(std::abs(e2) > kDependent))
        return false;
    const Real c = (third.offset - glm::dot(third.normal, result.point)) / e2;
    result.point += c * u;
    const Real m2 = c / e2, m1 = (b - m2 * glm::dot(third.normal, t)) / s1;
    result.multiplier = {a - m1 * c1 - m2 * glm::dot(third.normal, first.normal), m1, m2};
    return true;
}

} // namespace detail

/// For a convex problem the answer is the nearest intersection that violates no plane: at most fifteen are
/// tried.
template <class Real>
[[nodiscard]] FewPlanesGoal<Real> nearestOnPlanes(const glm::vec<3, Real>& goal,
                                                  const FewPlanes<Real>& planes) noexcept {
    const Real tolerance = 16 * std::numeric_limits<Real>::epsilon() * (Real(0.01) + glm::length(goal));
    const auto allowed = [&](const glm::vec<3, Real>& point, const FewPlanesGoal<Real>& of) {
        for (size_t i = 0; i < planes.count; ++i) {
            const bool on =
                std::find(of.active.begin(), of.active.begin() + of.count, i) != of.active.begin() + of.count;
            if (!on && glm::dot(planes.plane[i].normal, point) < planes.plane[i].offset - tolerance)
                return false;
        }
        return true;
    };
    FewPlanesGoal<Real> best;
    best.point = goal;
    if (allowed(goal, best))
        return best;
    best = {};
    best.found = false;
    Real least = std::numeric_limits<Real>::infinity();
    const auto consider = [&](const std::array<size_t, 3>& set, size_t count) {
        FewPlanesGoal<Real> trial;
        if (!detail::meetOf(goal, planes, set, count, trial))
            return;
        const glm::vec<3, Real> way = trial.point - goal;
        const Real squared = glm::dot(way, way);
        if (squared < least && allowed(trial.point, trial)) {
            least = squared;
            best = trial;
        }
    };
    for (size_t i = 0; i < planes.count; ++i) {
        consider({i, 0, 0}, 1);
        for (size_t k = i + 1; k < planes.count; ++k) {
            consider({i, k, 0}, 2);
            for (size_t l = k + 1; l < planes.count; ++l)
                consider({i, k, l}, 3);
        }
    }
    for (Real& multiplier : best.multiplier)
        multiplier = std::max(multiplier, Real(0));
    return best;
}

} // namespace touchstone
