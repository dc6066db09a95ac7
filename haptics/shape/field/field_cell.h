#pragma once
// One cell of a field: the trilinear polynomial between its eight nodes.

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

/// Coordinates u in a cell: 0..1 on each axis; beyond, the polynomial goes on.
struct FieldCell {
    /// f = c0 + c1 x + c2 y + c3 z + c4 x y + c5 y z + c6 z x + c7 x y z
    std::array<double, 8> c{};

    /// `node`: values at the corners, index x + 2 y + 4 z.
    [[nodiscard]] static FieldCell between(const std::array<double, 8>& node) noexcept {
        FieldCell cell;
        const auto& [a000, a100, a010, a110, a001, a101, a011, a111] = node;
        cell.c = {a000,
                  a100 - a000,
                  a010 - a000,
                  a001 - a000,
                  a110 - a100 - a010 + a000,
                  a011 - a010 - a001 + a000,
                  a101 - a100 - a001 + a000,
                  a111 - a110 - a101 - a011 + a100 + a010 + a001 - a000};
        return cell;
    }

    [[nodiscard]] double value(const glm::dvec3& u) const noexcept {
        return c[0] + u.x * (c[1] + u.y * c[4]) + u.y * (c[2] + u.z * c[5]) + u.z * (c[3] + u.x * c[6]) +
               u.x * u.y * u.z * c[7];
    }

    /// Per cell edge.
    [[nodiscard]] glm::dvec3 gradient(const glm::dvec3& u) const noexcept {
        return {c[1] + u.y * c[4] + u.z * c[6] + u.y * u.z * c[7],
                c[2] + u.x * c[4] + u.z * c[5] + u.z * u.x * c[7],
                c[3] + u.y * c[5] + u.x * c[6] + u.x * u.y * c[7]};
    }

    /// The second derivatives by yz, zx and xy; those by xx, yy and zz are 0.
    [[nodiscard]] glm::dvec3 mixed(const glm::dvec3& u) const noexcept {
        return {c[5] + u.x * c[7], c[6] + u.y * c[7], c[4] + u.z * c[7]};
    }

    /// The coefficients of f(u + t d), from t^0 to t^3.
    [[nodiscard]] std::array<double, 4> along(const glm::dvec3& u, const glm::dvec3& d) const noexcept {
        return {value(u), glm::dot(gradient(u), d),
                c[4] * d.x * d.y + c[5] * d.y * d.z + c[6] * d.z * d.x +
                    c[7] * (u.x * d.y * d.z + u.y * d.z * d.x + u.z * d.x * d.y),
                c[7] * d.x * d.y * d.z};
    }
};

/// A cubic in t, from t^0 to t^3.
[[nodiscard]] inline double cubicAt(const std::array<double, 4>& k, double t) noexcept {
    return k[0] + t * (k[1] + t * (k[2] + t * k[3]));
}

/// The first t in [from, to] from which on the cubic lies below `level`; INFINITY where it stays at or above
/// it. The value at the result is not below the level, but for rounding, or the result is `from`. Bounded: at
/// most three intervals in which the cubic is monotone, 60 steps in one of them.
[[nodiscard]] inline double firstBelow(const std::array<double, 4>& k, double level, double from,
                                       double to) noexcept {
    std::array<double, 4> ends{from, to, to, to};
    // k1 + 2 k2 t + 3 k3 t^2 = 0, by the form that does not cancel.
    const double a = 3.0 * k[3], b = k[2], discriminant = b * b - a * k[1];
    if (discriminant > 0.0) {
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));
        const double first = a != 0.0 ? q / a : to, second = q != 0.0 ? k[1] / q : to;
        ends[1] = std::clamp(std::isfinite(first) ? first : to, from, to);
        ends[2] = std::clamp(std::isfinite(second) ? second : to, from, to);
        if (ends[1] > ends[2])
            std::swap(ends[1], ends[2]);
    }
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
        double above = ends[i], below = ends[i + 1];
        if (!(cubicAt(k, below) < level))
            continue;
        if (!(cubicAt(k, above) > level))
            return above;
        for (int step = 0; step < 60; ++step) {
            const double middle = 0.5 * (above + below);
            if (!(middle > above) || !(middle < below))
                break;
            (cubicAt(k, middle) < level ? below : above) = middle;
        }
        return above;
    }
    return INFINITY;
}

} // namespace touchstone
