#include "haptics/query/ray_floor.h"

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/mesh/ray.h"

#include <limits>
#include <optional>

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
    const std::optional<RayHit> hit = castRay(*scene.objects[k], from, along, 0.0f, 1.0f);
    return hit ? hit->distance : std::numeric_limits<float>::infinity();
}

} // namespace touchstone
