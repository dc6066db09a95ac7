#pragma once
// Rays through TriangleTree, in double: for infrequent queries in any scene. (Embree's are in RayTree.)

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>

namespace touchstone {

struct HapticObject;

struct RayCrossing {
    uint32_t triangle;
    double distance; ///< in multiples of the direction's length
};

/// The first triangle of an object that the ray from + t * direction crosses with t > 0 and whose front, if
/// `frontsOnly`, faces the origin. Object frame; the direction is not zero. A ray through an edge of two
/// triangles crosses one of them. Safe on the servo thread.
[[nodiscard]] std::optional<RayCrossing> firstCrossing(const HapticObject& object, const glm::dvec3& from,
                                                       const glm::dvec3& direction, bool frontsOnly) noexcept;

/// The number of triangles that the ray crosses; empty where there are more than a tick can test.
[[nodiscard]] std::optional<uint32_t> crossings(const HapticObject& object, const glm::dvec3& from,
                                                const glm::dvec3& direction) noexcept;

} // namespace touchstone
