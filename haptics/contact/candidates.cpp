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
    double floatMargin;  ///< what rounding the centre to float may hide, object units
    double anchorPerObject;
    bool overflow = false;

    bool add(uint32_t triangle) {
        const uint32_t* index = &object->indices[3 * triangle];
        const glm::vec3 &a = object->vertices[index[0]], &b = object->vertices[index[1]],
                        &c = object->vertices[index[2]];
        // A leaf holds several triangles: drop those whose own box misses the ball.
        const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        const glm::vec3 outside = glm::max(glm::max(low - centre, centre - high), glm::vec3(0.0f));
        const float squared = glm::dot(outside, outside);
        if (squared > radiusSquared || index[0] == index[1] || index[1] == index[2] || index[2] == index[0])
            return true;
        if (cache->count_ == kCapacity)
            return false;
        Candidate& item = cache->items_[cache->count_];
        item.source = object;
        item.object = objectIndex;
        item.index = triangle;
        item.prepared = !sameFrame;
        if (!sameFrame)
            item.triangle =
                Triangle(anchorFromObject.point(glm::dvec3(a)), anchorFromObject.point(glm::dvec3(b)),
                         anchorFromObject.point(glm::dvec3(c)));
        const double away = static_cast<double>(std::sqrt(squared)) - floatMargin;
        cache->lowerBounds_[cache->count_] = away * anchorPerObject;
        ++cache->count_;
        return true;
    }
};

void CandidateCache::prepare(Candidate& item) noexcept {
    const HapticObject& object = *item.source;
    const uint32_t* index = &object.indices[3 * item.index];
    item.triangle = Triangle(glm::dvec3(object.vertices[index[0]]), glm::dvec3(object.vertices[index[1]]),
                             glm::dvec3(object.vertices[index[2]]));
    item.prepared = true;
}

bool CandidateCache::gatherObject(const HapticObject& object, int index, const Similarity* objectFromAnchor,
                                  const glm::dvec3& centre, double radius) noexcept {
    const bool foreign = objectFromAnchor != nullptr;
    const double scale = foreign ? objectFromAnchor->scale : 1.0;
    const glm::dvec3 local = foreign ? objectFromAnchor->point(centre) : centre;
    const double localRadius = scale * radius;
    if (glm::length(local) - object.boundingRadius > localRadius)
        return true;
    // Embree works in float on vertices of magnitude one: widen the ball by more than their rounding.
    const double floatMargin = 4e-7 * (1.0 + glm::length(local));
    const float floatRadius = static_cast<float>(localRadius + floatMargin);
    Visit visit{.cache = this,
                .object = &object,
                .objectIndex = index,
                .sameFrame = !foreign,
                .anchorFromObject = foreign ? objectFromAnchor->inverse() : Similarity{},
                .centre = glm::vec3(local),
                .radiusSquared = floatRadius * floatRadius,
                .floatMargin = floatMargin,
                .anchorPerObject = 1.0 / scale};
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
    return !visit.overflow;
}

bool CandidateCache::gather(std::span<const std::unique_ptr<const HapticObject>> objects, ObjectMotions poses,
                            int anchor, const glm::dvec3& centre, double radius) noexcept {
    invalidate();
    centre_ = centre;
    radius_ = radius;
    const Similarity& workspaceFromAnchor = poses[static_cast<size_t>(anchor)].workspaceFromObject;
    for (size_t k = 0; k < objects.size(); ++k) {
        const int index = static_cast<int>(k);
        bool fits = true;
        if (index == anchor) {
            fits = gatherObject(*objects[k], index, nullptr, centre, radius);
        } else {
            const Similarity objectFromAnchor = poses[k].workspaceFromObject.inverse() * workspaceFromAnchor;
            fits = gatherObject(*objects[k], index, &objectFromAnchor, centre, radius);
        }
        if (!fits) {
            invalidate();
            return false;
        }
    }
    valid_ = true;
    return true;
}

} // namespace touchstone
