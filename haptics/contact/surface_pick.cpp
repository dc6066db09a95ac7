#include "haptics/contact/surface_pick.h"

#include "haptics/contact/ray.h"
#include "haptics/contact/triangle.h"
#include "haptics/haptic_scene.h"

#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// A one-sided model that is seen from inside shows its back again and again; what lies behind that many is
/// not looked for.
constexpr int kMostBacks = 64;

struct ObjectHit {
    double distance; ///< object units
    glm::dvec3 normal;
};

std::optional<ObjectHit> hitObject(const HapticObject& object, const glm::dvec3& from,
                                   const glm::dvec3& direction) noexcept {
    float near = 0.0f;
    for (int i = 0; i < kMostBacks; ++i) {
        const std::optional<RayHit> hit = castRay(object, glm::vec3(from), glm::vec3(direction), near,
                                                  std::numeric_limits<float>::infinity());
        if (!hit)
            return std::nullopt;
        const Triangle t = triangleOf(object, hit->triangle);
        const double facing = glm::dot(t.normal, direction);
        if (object.oneSided && facing >= 0.0) {
            near = std::nextafter(hit->distance, std::numeric_limits<float>::infinity());
            continue;
        }
        // Seen edge-on the plane says nothing, the ray's own distance does.
        constexpr double kEdgeOn = 1e-6;
        const double distance = std::abs(facing) > kEdgeOn ? glm::dot(t.normal, t.a - from) / facing
                                                           : static_cast<double>(hit->distance);
        return ObjectHit{distance, facing > 0.0 ? -t.normal : t.normal};
    }
    return std::nullopt;
}

} // namespace

std::optional<SurfacePick> pickSurface(const HapticScene& scene, ObjectMotions motions,
                                       const glm::dvec3& from, const glm::dvec3& direction) noexcept {
    const ObjectMotions poses = motions.empty() ? ObjectMotions(scene.restMotions) : motions;
    std::optional<SurfacePick> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const Similarity& pose = poses[k].workspaceFromObject;
        const HapticObject& object = *scene.objects[k];
        const glm::dvec3 along = glm::conjugate(pose.rotation) * direction;
        const std::optional<ObjectHit> hit = hitObject(object, pose.inversePoint(from), along);
        if (!hit || pose.scale * hit->distance >= least)
            continue;
        least = pose.scale * hit->distance;
        nearest = SurfacePick{from + least * direction, pose.direction(hit->normal), static_cast<int>(k),
                              object.material};
    }
    return nearest;
}

} // namespace touchstone
