#include "haptics/shape/mesh/ray_walk.h"

#include "haptics/shape/mesh/haptic_object.h"
#include "haptics/shape/mesh/triangle_tree_ray.h"

#include <array>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// dot(direction, cross(a - from, b - from)): on which side of the edge the ray passes. The edge runs from
/// its lower to its upper vertex, so that two triangles that share it get the same number with opposite
/// signs, and zero, which counts as positive, lies in one of them.
///
/// Out of line: inlined, its multiplications and additions might be contracted in one place and not in
/// another.
[[gnu::noinline]] bool passesLeft(const HapticObject& object, uint32_t a, uint32_t b, const glm::dvec3& from,
                                  const glm::dvec3& direction) noexcept {
    const bool swapped = a > b;
    const glm::dvec3 low = vertexOf(object, swapped ? b : a) - from,
                     high = vertexOf(object, swapped ? a : b) - from;
    return (glm::dot(direction, glm::cross(low, high)) >= 0.0) != swapped;
}

/// Where the ray crosses a triangle, in multiples of the direction's length; NaN if it does not. `back`: it
/// comes from the back.
double crossingAt(const HapticObject& object, uint32_t triangle, const glm::dvec3& from,
                  const glm::dvec3& direction, bool& back) noexcept {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const uint32_t* v = &object.indices[3 * static_cast<size_t>(triangle)];
    const bool left = passesLeft(object, v[0], v[1], from, direction);
    if (passesLeft(object, v[1], v[2], from, direction) != left ||
        passesLeft(object, v[2], v[0], from, direction) != left)
        return kNone;
    const glm::dvec3 a = vertexOf(object, v[0]), b = vertexOf(object, v[1]), c = vertexOf(object, v[2]);
    const glm::dvec3 area = glm::cross(b - a, c - a);
    const double rate = glm::dot(direction, area);
    back = rate > 0.0;
    return rate == 0.0 ? kNone : glm::dot(a - from, area) / rate;
}

/// The part of a ray inside the ball that contains the object. A walk begins there, since a start far away
/// adds its rounding.
struct Stretch {
    double begin, end; ///< in multiples of the direction's length; end < begin: empty
};
Stretch withinReach(const HapticObject& object, const glm::dvec3& from,
                    const glm::dvec3& direction) noexcept {
    const double reach = 1.001 * object.boundingRadius + 1e-3;
    const double squared = glm::dot(direction, direction);
    const double nearest = -glm::dot(from, direction) / squared;
    const glm::dvec3 miss = from + nearest * direction;
    const double half2 = (reach * reach - glm::dot(miss, miss)) / squared;
    if (!(half2 >= 0.0))
        return {1.0, 0.0};
    const double half = std::sqrt(half2);
    return {std::max(nearest - half, 0.0), nearest + half};
}

} // namespace

std::optional<RayCrossing> firstCrossing(const HapticObject& object, const glm::dvec3& from,
                                         const glm::dvec3& direction, bool frontsOnly) noexcept {
    const Stretch stretch = withinReach(object, from, direction);
    std::optional<RayCrossing> first;
    if (stretch.end < stretch.begin)
        return first;
    double end = stretch.end - stretch.begin;
    const glm::dvec3 start = from + stretch.begin * direction;
    treeOf(object).walkRay(start, direction, end, [&](uint32_t triangle) {
        bool back = false;
        const double t = crossingAt(object, triangle, start, direction, back);
        if (t > 0.0 && !(back && frontsOnly) && (!first || t < end)) {
            first = RayCrossing{triangle, stretch.begin + t};
            end = t;
        }
        return true;
    });
    return first;
}

std::optional<uint32_t> crossings(const HapticObject& object, const glm::dvec3& from,
                                  const glm::dvec3& direction) noexcept {
    constexpr uint32_t kMaxTriangles = 16384;
    const Stretch stretch = withinReach(object, from, direction);
    if (stretch.end < stretch.begin)
        return 0;
    const double end = stretch.end - stretch.begin;
    const glm::dvec3 start = from + stretch.begin * direction;
    uint32_t count = 0, left = kMaxTriangles;
    treeOf(object).walkRay(start, direction, end, [&](uint32_t triangle) {
        bool back = false;
        count += crossingAt(object, triangle, start, direction, back) > 0.0 ? 1 : 0;
        return --left > 0;
    });
    return left > 0 ? std::optional(count) : std::nullopt;
}

bool insideObject(const HapticObject& object, const glm::dvec3& point) noexcept {
    if (object.shape != nullptr)
        return object.shape->contains(point);
    if (!object.closed || glm::length(point) > object.boundingRadius)
        return false;
    // Directions without a simple relation to the axes, so that no ray runs along a facet of a box.
    constexpr std::array<glm::dvec3, 3> kDirections{glm::dvec3(0.4823, 0.7617, 0.4327),
                                                    glm::dvec3(-0.8019, 0.2673, 0.5345),
                                                    glm::dvec3(0.1690, -0.5071, -0.8452)};
    int votes = 0;
    for (const glm::dvec3& direction : kDirections)
        votes += crossings(object, point, direction).value_or(0) % 2 != 0 ? 1 : 0;
    return votes >= 2;
}

} // namespace touchstone
