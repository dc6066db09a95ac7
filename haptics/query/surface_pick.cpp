#include "haptics/query/surface_pick.h"

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/contact.h"
#include "haptics/shape/mesh/ray_walk.h"
#include "haptics/shape/mesh/triangle.h"

#include <array>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

struct ObjectHit {
    double distance; ///< object units
    glm::dvec3 normal;
};

std::optional<ObjectHit> hitObject(const HapticObject& object, const glm::dvec3& from,
                                   const glm::dvec3& direction) noexcept {
    if (const Shape* shape = object.shape.get()) { // a ball of radius zero
        const double far = glm::length(from) + object.boundingRadius;
        const double impact = shape->sweep(from, 0.0, far * direction, 1.0);
        if (!(impact < 1.0))
            return std::nullopt;
        std::array<FeatureDistance, 1> met;
        const bool found = shape->near(from + impact * far * direction, kContactReach, met) > 0;
        return ObjectHit{impact * far, found ? met[0].gradient : -direction};
    }
    const std::optional<RayCrossing> hit = firstCrossing(object, from, direction, object.oneSided);
    if (!hit)
        return std::nullopt;
    const glm::dvec3 normal = triangleOf(object, hit->triangle).normal;
    return ObjectHit{hit->distance, glm::dot(normal, direction) > 0.0 ? -normal : normal};
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
