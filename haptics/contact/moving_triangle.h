#pragma once
// A ball and a triangle that both move straight and at constant speed through a step, each corner its own
// way: continuous collision by separating planes.

#include "haptics/shape/mesh/triangle.h"

#include <glm/glm.hpp>

namespace touchstone {

/// A triangle at the start and at the end of a step. Collapsed and inverted ones are allowed.
struct MovingTriangle {
    Triangle start, end;

    [[nodiscard]] Triangle at(double time) const noexcept {
        return {start.a + time * (end.a - start.a), start.b + time * (end.b - start.b),
                start.c + time * (end.c - start.c)};
    }
};

/// True where a point that moves from `from` to `to` is shown to stay at least `keep` > 0 away from the
/// triangle throughout; false where it is not, or where kClearPieces pieces do not show it. Never true for a
/// point that comes nearer.
///
/// At a time t let n(t) be the distance's gradient: all corners x_v satisfy n . (c - x_v) >= distance, since
/// a triangle is convex. Over a piece of the step let n be the chord of the gradients at its ends, so |n|
/// <= 1. Then g_v(t) = n(t) . (c(t) - x_v(t)) is a quadratic of t, which nowhere falls below the least of its
/// three Bernstein coefficients g_v(0), (n(0) . w_v(1) + n(1) . w_v(0)) / 2 and g_v(1), w_v = c - x_v. Where
/// the nine numbers of the three corners are at least `keep` the triangle lies behind a plane that is `keep`
/// away. The middle one falls short of the mean of the others by (n(1) - n(0)) . (w_v(1) - w_v(0)) / 2: by a
/// fourth of that with each halving of the piece.
[[nodiscard]] bool staysClear(const MovingTriangle& triangle, const glm::dvec3& from, const glm::dvec3& to,
                              double keep) noexcept;

/// Where a point near the triangle goes if it keeps its place beside it: the nearest point's weights of the
/// corners stay, and its offset turns with the triangle.
[[nodiscard]] glm::dvec3 carriedAlong(const MovingTriangle& triangle, const glm::dvec3& point) noexcept;

} // namespace touchstone
