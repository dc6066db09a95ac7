#pragma once

#include "haptics/shape/mesh/embree.h"
#include "haptics/shape/mesh/haptic_object.h"

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <optional>

namespace touchstone {

struct RayHit {
    uint32_t triangle;
    float distance; ///< in multiples of the direction's length
};

/// Embree takes coordinates of at most 1.844e18 (its Ray::valid), and Debian's build asserts it.
inline constexpr float kEmbreeReach = 1e18f;

/// The first triangle of an object that the ray from + t * direction meets at near <= t <= far (near >= 0);
/// object frame. Empty where the ray begins beyond kEmbreeReach, as it does from the HIP to an object 1e-18
/// of its size beside it: floats could not resolve a hit there. A shape that is not a mesh has no triangle.
/// One rtcIntersect1 of Embree, ROBUST and in float; inline, since the ray floor is nothing else. The
/// object's rays must be built. Safe on the servo thread.
[[nodiscard]] inline std::optional<RayHit> castRay(const HapticObject& object, const glm::vec3& from,
                                                   const glm::vec3& direction, float near,
                                                   float far) noexcept {
    const auto within = [](const glm::vec3& v) {
        return std::abs(v.x) < kEmbreeReach && std::abs(v.y) < kEmbreeReach && std::abs(v.z) < kEmbreeReach;
    };
    if (!within(from) || !within(direction) || !(near <= far) || object.shape != nullptr)
        return std::nullopt;
    RTCRayHit hit;
    hit.ray.org_x = from.x;
    hit.ray.org_y = from.y;
    hit.ray.org_z = from.z;
    hit.ray.dir_x = direction.x;
    hit.ray.dir_y = direction.y;
    hit.ray.dir_z = direction.z;
    hit.ray.tnear = near;
    hit.ray.tfar = far;
    hit.ray.time = 0.0f;
    hit.ray.mask = ~0u;
    hit.ray.id = 0;
    hit.ray.flags = 0;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersectRay(object.rays.get(), hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    return RayHit{hit.hit.primID, hit.ray.tfar};
}

} // namespace touchstone
