#include "haptics/contact/ray_floor.h"

#include "haptics/haptic_scene.h"

#include <embree3/rtcore.h>

#include <limits>

namespace touchstone {

float castFloorRay(const HapticScene& scene, int object, const glm::dvec3& proxy,
                   const glm::dvec3& hip) noexcept {
    return castFloorRay(scene, object, scene.restMotions[static_cast<size_t>(object)].workspaceFromObject,
                        proxy, hip);
}

float castFloorRay(const HapticScene& scene, int object, const Similarity& workspaceFromObject,
                   const glm::dvec3& proxy, const glm::dvec3& hip) noexcept {
    const auto k = static_cast<size_t>(object);
    const Similarity objectFromWorkspace = workspaceFromObject.inverse();
    const glm::vec3 from(objectFromWorkspace.point(proxy));
    const glm::vec3 along = glm::vec3(objectFromWorkspace.point(hip)) - from;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit hit;
    hit.ray.org_x = from.x;
    hit.ray.org_y = from.y;
    hit.ray.org_z = from.z;
    hit.ray.dir_x = along.x;
    hit.ray.dir_y = along.y;
    hit.ray.dir_z = along.z;
    hit.ray.tnear = 0.0f;
    hit.ray.tfar = 1.0f;
    hit.ray.time = 0.0f;
    hit.ray.mask = ~0u;
    hit.ray.id = 0;
    hit.ray.flags = 0;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.objects[k]->bvh.get(), &context, &hit);
    return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : hit.ray.tfar;
}

} // namespace touchstone
