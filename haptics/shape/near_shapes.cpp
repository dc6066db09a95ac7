#include "haptics/shape/near_shapes.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

bool NearShapes::add(const Shape& shape, int object, const Similarity* objectFromAnchor) noexcept {
    if (count_ == kMostShapes)
        return false;
    Placed& placed = placed_[count_++];
    placed = {&shape, object, {}, {}};
    if (objectFromAnchor != nullptr) {
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
        limit = placed.shape->sweep(objectFromAnchor.point(p), objectFromAnchor.scale * reach,
                                    objectFromAnchor.vector(move), limit);
    }
    return limit;
}

double NearShapes::nearest(const glm::dvec3& p, double reach) const noexcept {
    double least = INFINITY;
    eachNear(p, reach, [&](int, const FeatureDistance& d) { least = std::min(least, d.distance); });
    return least;
}

} // namespace touchstone
