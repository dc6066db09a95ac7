#include "haptics/contact/candidates.h"

#include <embree3/rtcore.h>

#include <cmath>

namespace touchstone {

/// What Embree's callback needs for one object.
struct CandidateCache::Visit {
    CandidateCache* cache;
    const HapticObject* object;
    int objectIndex;
    bool sameFrame; ///< the object is the anchor
    Similarity anchorFromObject;
    glm::vec3 centre;    ///< of the ball, object frame
    float radiusSquared; ///< with the float margin
    bool overflow = false;

    bool add(uint32_t triangle) {
        const glm::vec3 corner[3] = {object->vertices[object->indices[3 * triangle]],
                                     object->vertices[object->indices[3 * triangle + 1]],
                                     object->vertices[object->indices[3 * triangle + 2]]};
        // A leaf holds several triangles: drop those whose own box misses the ball.
        const glm::vec3 low = glm::min(corner[0], glm::min(corner[1], corner[2]));
        const glm::vec3 high = glm::max(corner[0], glm::max(corner[1], corner[2]));
        const glm::vec3 outside = glm::max(glm::max(low - centre, centre - high), glm::vec3(0.0f));
        if (glm::dot(outside, outside) > radiusSquared)
            return true;
        const uint32_t* index = &object->indices[3 * triangle];
        if (index[0] == index[1] || index[1] == index[2] || index[2] == index[0])
            return true;
        if (cache->count_ == kCapacity)
            return false;
        Candidate& item = cache->items_[cache->count_];
        if (sameFrame)
            item.triangle = Triangle(glm::dvec3(corner[0]), glm::dvec3(corner[1]), glm::dvec3(corner[2]));
        else
            item.triangle = Triangle(anchorFromObject.point(glm::dvec3(corner[0])),
                                     anchorFromObject.point(glm::dvec3(corner[1])),
                                     anchorFromObject.point(glm::dvec3(corner[2])));
        item.object = objectIndex;
        item.index = triangle;
        cache->lowerBounds_[cache->count_] = 0.0;
        ++cache->count_;
        return true;
    }
};

bool CandidateCache::gather(std::span<const std::unique_ptr<const HapticObject>> objects, ObjectMotions poses,
                            int anchor, const glm::dvec3& centre, double radius) noexcept {
    invalidate();
    centre_ = centre;
    radius_ = radius;
    const Similarity& workspaceFromAnchor = poses[static_cast<size_t>(anchor)].workspaceFromObject;
    for (size_t k = 0; k < objects.size(); ++k) {
        const HapticObject& object = *objects[k];
        Visit visit{.cache = this,
                    .object = &object,
                    .objectIndex = static_cast<int>(k),
                    .sameFrame = static_cast<int>(k) == anchor,
                    .anchorFromObject = {},
                    .centre = glm::vec3(centre),
                    .radiusSquared = 0.0f};
        glm::dvec3 local = centre;
        double localRadius = radius;
        if (!visit.sameFrame) {
            const Similarity objectFromAnchor = poses[k].workspaceFromObject.inverse() * workspaceFromAnchor;
            local = objectFromAnchor.point(centre);
            localRadius *= objectFromAnchor.scale;
        }
        const double gap = glm::length(local) - object.boundingRadius;
        if (gap > localRadius)
            continue;
        if (!visit.sameFrame)
            visit.anchorFromObject = workspaceFromAnchor.inverse() * poses[k].workspaceFromObject;
        // Embree works in float on vertices of magnitude one: widen the ball by more than their rounding.
        const double magnitude = 1.0 + glm::length(local);
        const float floatRadius = static_cast<float>(localRadius + 4e-7 * magnitude);
        visit.centre = glm::vec3(local);
        visit.radiusSquared = floatRadius * floatRadius;

        RTCPointQuery query{};
        query.x = visit.centre.x;
        query.y = visit.centre.y;
        query.z = visit.centre.z;
        query.radius = floatRadius;
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        const auto collect = [](RTCPointQueryFunctionArguments* arguments) -> bool {
            auto& v = *static_cast<Visit*>(arguments->userPtr);
            if (v.overflow || v.add(arguments->primID))
                return false;
            v.overflow = true;
            arguments->query->radius = 0.0f; // nothing more is wanted: let the traversal end
            return true;
        };
        rtcPointQuery(object.bvh.get(), &query, &context, collect, &visit);
        if (visit.overflow) {
            invalidate();
            return false;
        }
    }
    valid_ = true;
    return true;
}

} // namespace touchstone
