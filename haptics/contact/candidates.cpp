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
    glm::dvec3 centreInAnchor;
    glm::dvec3 centre; ///< of the ball, object frame
    glm::vec3 floatCentre;
    float radiusSquared; ///< with the float margin
    double anchorPerObject;
    bool overflow = false;

    bool add(uint32_t triangle) {
        const uint32_t* index = &object->indices[3 * triangle];
        const glm::vec3 &a = object->vertices[index[0]], &b = object->vertices[index[1]],
                        &c = object->vertices[index[2]];
        // A leaf holds several triangles: drop those whose own box misses the ball.
        const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        const glm::vec3 outside = glm::max(glm::max(low - floatCentre, floatCentre - high), glm::vec3(0.0f));
        if (glm::dot(outside, outside) > radiusSquared || index[0] == index[1] || index[1] == index[2] ||
            index[2] == index[0])
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
        const glm::dvec3 away = centre - glm::clamp(centre, glm::dvec3(low), glm::dvec3(high));
        const double distance = glm::length(away);
        glm::dvec3 gradient = distance > 0.0 ? away / distance : glm::dvec3(0.0);
        if (!sameFrame)
            gradient = anchorFromObject.direction(gradient);
        item.measured = 0;
        cache->setBound(cache->count_, centreInAnchor, distance * anchorPerObject, gradient);
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
                .centreInAnchor = centre,
                .centre = local,
                .floatCentre = glm::vec3(local),
                .radiusSquared = floatRadius * floatRadius,
                .anchorPerObject = 1.0 / scale};
    RTCPointQuery query{};
    query.x = visit.floatCentre.x;
    query.y = visit.floatCentre.y;
    query.z = visit.floatCentre.z;
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
            const Similarity objectFromAnchor =
                poses[k].workspaceFromObject.inverseTimes(workspaceFromAnchor);
            fits = gatherObject(*objects[k], index, &objectFromAnchor, centre, radius);
        }
        if (!fits) {
            invalidate();
            return false;
        }
    }
    for (size_t i = count_; i % kBlock != 0; ++i)
        setBound(i, glm::dvec3(0.0), INFINITY, glm::dvec3(0.0));
    valid_ = true;
    return true;
}

std::span<CandidateCache::Approach> CandidateCache::approaching(const glm::dvec3& p, const glm::dvec3& move,
                                                                double limit, double reach) noexcept {
    const double doubt = uncertainty();
    size_t found = 0;
    for (size_t first = 0; first < count_; first += kBlock) {
        const Block& block = bounds_[first / kBlock];
        std::array<double, kBlock> gap, rate;
        for (size_t k = 0; k < kBlock; ++k) {
            gap[k] = block.x[k] * p.x + block.y[k] * p.y + block.z[k] * p.z + block.offset[k] - reach;
            rate[k] = block.x[k] * move.x + block.y[k] * move.y + block.z[k] * move.z;
        }
        for (size_t k = 0; k < kBlock; ++k) {
            if (gap[k] + std::min(0.0, limit * rate[k]) > doubt)
                continue;
            // Where the bound was evaluated at p there is no doubt about it.
            const auto i = static_cast<uint32_t>(first + k);
            const bool here = items_[i].measured == place_;
            if (here && rate[k] >= 0.0)
                continue;
            const double free = here ? gap[k] : gap[k] - doubt;
            approaches_[found++] = {.time = free > 0.0 ? free / -rate[k] : 0.0, .index = i, .steps = 0};
        }
    }
    return {approaches_.data(), found};
}

} // namespace touchstone
