#include "haptics/contact/moving_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// A point that keeps its distance needs one piece; one that slips past an edge some ten.
constexpr int kClearPieces = 64;
/// Halvings: a gap that closes within 1/4096 of a step counts as closed.
constexpr int kDeepest = 12;

struct End {
    double time = 0.0;
    Triangle triangle;
    glm::dvec3 point{0.0};
    TriangleDistance distance;
};

std::array<glm::dvec3, 3> towards(const End& end) {
    return {end.point - end.triangle.a, end.point - end.triangle.b, end.point - end.triangle.c};
}

bool separated(const End& first, const End& last, double keep) {
    const glm::dvec3 &n0 = first.distance.gradient, &n1 = last.distance.gradient;
    const std::array<glm::dvec3, 3> w0 = towards(first), w1 = towards(last);
    for (size_t v = 0; v < 3; ++v) {
        const double least = std::min(
            {glm::dot(n0, w0[v]), 0.5 * (glm::dot(n0, w1[v]) + glm::dot(n1, w0[v])), glm::dot(n1, w1[v])});
        if (!(least >= keep))
            return false;
    }
    return true;
}

/// Axes that turn with the triangle: its normal, an edge, and the third. Zero where it has collapsed.
glm::dmat3 axesOf(const Triangle& triangle) {
    const glm::dvec3 edge = triangle.b - triangle.a;
    const double length = glm::length(edge);
    if (triangle.normal == glm::dvec3(0.0) || !(length > 0.0))
        return glm::dmat3(0.0);
    const glm::dvec3 along = edge / length;
    return {triangle.normal, along, glm::cross(triangle.normal, along)};
}

} // namespace

bool staysClear(const MovingTriangle& triangle, const glm::dvec3& from, const glm::dvec3& to,
                double keep) noexcept {
    const auto endAt = [&](double time) {
        End end{.time = time,
                .triangle = time == 0.0   ? triangle.start
                            : time == 1.0 ? triangle.end
                                          : triangle.at(time),
                .point = time == 0.0   ? from
                         : time == 1.0 ? to
                                       : from + time * (to - from),
                .distance = {}};
        end.distance = distanceTo(end.triangle, end.point);
        return end;
    };
    // The ends of the pieces to come, the next one last.
    std::array<End, kDeepest + 1> waiting;
    size_t count = 0;
    waiting[count++] = endAt(1.0);
    End first = endAt(0.0);
    if (first.distance.distance < keep || waiting[0].distance.distance < keep)
        return false;
    for (int piece = 0; piece < kClearPieces; ++piece) {
        const End& last = waiting[count - 1];
        if (separated(first, last, keep)) {
            first = last;
            if (--count == 0)
                return true;
            continue;
        }
        if (count == waiting.size())
            return false;
        const End middle = endAt(0.5 * (first.time + last.time));
        if (middle.distance.distance < keep)
            return false;
        waiting[count++] = middle;
    }
    return false;
}

glm::dvec3 carriedAlong(const MovingTriangle& triangle, const glm::dvec3& point) noexcept {
    const TriangleDistance here = distanceTo(triangle.start, point);
    const glm::dvec3 weight = barycentric(triangle.start, here.closest);
    const glm::dvec3 closest =
        weight.x * triangle.end.a + weight.y * triangle.end.b + weight.z * triangle.end.c;
    const glm::dvec3 offset = point - here.closest;
    const glm::dmat3 before = axesOf(triangle.start), after = axesOf(triangle.end);
    const bool turns = before[0] != glm::dvec3(0.0) && after[0] != glm::dvec3(0.0);
    return closest + (turns ? after * (glm::transpose(before) * offset) : offset);
}

} // namespace touchstone
