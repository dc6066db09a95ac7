#pragma once
// The distance of a point from a triangle, exact in double, with its gradient.

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace touchstone {

/// A triangle ready for distance queries; any consistent frame and unit. The normal is zero when the corners
/// are collinear: then only the edges count, and neighbours or the slab of those edges close the surface.
struct Triangle {
    glm::dvec3 a, b, c;
    glm::dvec3 normal{0.0}; ///< unit, counter-clockwise

    Triangle() = default;
    Triangle(const glm::dvec3& a_, const glm::dvec3& b_, const glm::dvec3& c_) : a(a_), b(b_), c(c_) {
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const double squared = glm::dot(area, area);
        if (squared > 0.0)
            normal = area / std::sqrt(squared);
    }
};

/// Distance from a point: convex along any line, because a triangle is convex.
struct TriangleDistance {
    double distance = 0.0;
    glm::dvec3 gradient{0.0}; ///< unit, from the triangle to the point
    glm::dvec3 closest{0.0};
    bool face = false; ///< the closest point lies inside the face, not on an edge or vertex
};

namespace detail {

inline glm::dvec3 closestOnSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 ab = b - a;
    const double squared = glm::dot(ab, ab);
    const double t = squared > 0.0 ? glm::dot(p - a, ab) / squared : 0.0;
    // Ends are returned to the last bit, so that triangles that share a vertex agree on it.
    if (t <= 0.0)
        return a;
    if (t >= 1.0)
        return b;
    return a + t * ab;
}

} // namespace detail

/// In the face region the gradient is the face normal itself, not a quotient of small differences: coplanar
/// neighbours then agree to the last bit even for a proxy of radius almost zero.
inline TriangleDistance distanceTo(const Triangle& triangle, const glm::dvec3& p) {
    const glm::dvec3& n = triangle.normal;
    const glm::dvec3 ap = p - triangle.a, bp = p - triangle.b, cp = p - triangle.c;
    const double sideAb = glm::dot(glm::cross(triangle.b - triangle.a, ap), n);
    const double sideBc = glm::dot(glm::cross(triangle.c - triangle.b, bp), n);
    const double sideCa = glm::dot(glm::cross(triangle.a - triangle.c, cp), n);
    TriangleDistance result;
    if (sideAb > 0.0 && sideBc > 0.0 && sideCa > 0.0) {
        const double height = glm::dot(ap, n);
        result.distance = std::abs(height);
        result.gradient = height >= 0.0 ? n : -n;
        result.closest = p - height * n;
        result.face = true;
        return result;
    }
    // Outside at least one edge: the closest point lies on one of the edges that p is outside of.
    double best = INFINITY;
    const auto tryEdge = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec3 candidate = detail::closestOnSegment(p, from, to);
        const glm::dvec3 away = p - candidate;
        const double squared = glm::dot(away, away);
        if (squared < best) {
            best = squared;
            result.closest = candidate;
            result.gradient = away;
        }
    };
    if (sideAb <= 0.0)
        tryEdge(triangle.a, triangle.b);
    if (sideBc <= 0.0)
        tryEdge(triangle.b, triangle.c);
    if (sideCa <= 0.0)
        tryEdge(triangle.c, triangle.a);
    result.distance = std::sqrt(best);
    result.gradient = result.distance > 0.0 ? result.gradient / result.distance : n;
    return result;
}

/// Weights of the corners for a point in the triangle's plane, by the areas of the sub-triangles [000 §4.1].
/// On a degenerate triangle the nearest corner takes all.
inline glm::dvec3 barycentric(const Triangle& triangle, const glm::dvec3& p) {
    const glm::dvec3& n = triangle.normal;
    const double areaA = glm::dot(glm::cross(triangle.c - triangle.b, p - triangle.b), n);
    const double areaB = glm::dot(glm::cross(triangle.a - triangle.c, p - triangle.c), n);
    const double areaC = glm::dot(glm::cross(triangle.b - triangle.a, p - triangle.a), n);
    const glm::dvec3 weights(std::max(areaA, 0.0), std::max(areaB, 0.0), std::max(areaC, 0.0));
    const double sum = weights.x + weights.y + weights.z;
    if (sum > 0.0)
        return weights / sum;
    const double da = glm::dot(p - triangle.a, p - triangle.a), db = glm::dot(p - triangle.b, p - triangle.b),
                 dc = glm::dot(p - triangle.c, p - triangle.c);
    if (da <= db && da <= dc)
        return {1.0, 0.0, 0.0};
    return db <= dc ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
}

} // namespace touchstone
