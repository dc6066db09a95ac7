#include "haptics/shape/near_shapes.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

bool NearShapes::add(const Shape& shape, int object, const Similarity* objectFromAnchor,
                     const glm::dvec3& centre, double radius) noexcept {
    const bool foreign = objectFromAnchor != nullptr;
    std::array<FeatureDistance, 1> any;
    if (shape.near(foreign ? objectFromAnchor->point(centre) : centre,
                   foreign ? objectFromAnchor->scale * radius : radius, any) == 0)
        return true;
    if (count_ == kMostShapes)
        return false;
    Placed& placed = placed_[count_++];
    placed = {&shape, object, {}, {}};
    if (foreign) {
        placed.objectFromAnchor = *objectFromAnchor;
        placed.anchorFromObject = objectFromAnchor->inverse();
    }
    return true;
}

double NearShapes::sweep(const glm::dvec3& p, const glm::dvec3& move, double reach,
                         double limit) const noexcept {
    for (size_t i = 0; i < count_; ++i) {
        const Placed& placed = placed_[i];
        const Similarity& objectFromAnchor = placed.objectFromAnchor;
        const double impact = placed.shape->sweep(objectFromAnchor.point(p), objectFromAnchor.scale * reach,
                                                  objectFromAnchor.vector(move), limit);
        limit = impact > 0.0 ? std::min(impact, limit) : 0.0; // no number is no free way
    }
    return limit;
}

double NearShapes::nearest(const glm::dvec3& p, double reach) const noexcept {
    double least = INFINITY;
    (void)eachNear(p, reach, [&](int, const FeatureDistance& d) { least = std::min(least, d.distance); });
    return least;
}

} // namespace touchstone
