#include "haptics/shape/near_shapes.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

bool NearShapes::add(const Shape& shape, int object, const Similarity* objectFromReference,
                     const glm::dvec3& centre, double radius) noexcept {
    const bool foreign = objectFromReference != nullptr;
    std::array<FeatureDistance, 1> any;
    // A shape's distance may exceed the true one (a field's by up to its Lipschitz bound, the root of 3).
    const double wide = 2.0 * radius;
    if (shape.near(foreign ? objectFromReference->point(centre) : centre,
                   foreign ? objectFromReference->scale * wide : wide, any) == 0)
        return true;
    if (count_ == kMaxShapes)
        return false;
    Placed& placed = placed_[count_++];
    placed = {&shape, object, {}, {}};
    if (foreign) {
        placed.objectFromReference = *objectFromReference;
        placed.referenceFromObject = objectFromReference->inverse();
    }
    return true;
}

double NearShapes::sweep(const glm::dvec3& p, const glm::dvec3& move, double reach,
                         double limit) const noexcept {
    for (size_t i = 0; i < count_; ++i) {
        const Placed& placed = placed_[i];
        const Similarity& objectFromReference = placed.objectFromReference;
        const double impact =
            placed.shape->sweep(objectFromReference.point(p), objectFromReference.scale * reach,
                                objectFromReference.vector(move), limit);
        limit = impact > 0.0 ? std::min(impact, limit) : 0.0; // NaN counts as no free path
    }
    return limit;
}

const NearShapes::Placed* NearShapes::find(int object) const noexcept {
    for (size_t i = 0; i < count_; ++i)
        if (placed_[i].object == object)
            return &placed_[i];
    return nullptr;
}

bool NearShapes::seen(int object, FeatureId feature, const glm::dvec3& p,
                      FeatureDistance& found) const noexcept {
    const Placed* const placed = find(object);
    if (placed == nullptr)
        return false;
    found = inReference(*placed, placed->shape->distanceFrom(feature, placed->objectFromReference.point(p)));
    return true;
}

bool NearShapes::restNear(int object, const glm::dvec3& from, const glm::dvec3& goal, double distance,
                          glm::dvec3& place) const noexcept {
    const Placed* const placed = find(object);
    if (placed == nullptr)
        return false;
    const Similarity& objectFromReference = placed->objectFromReference;
    if (!placed->shape->restNear(objectFromReference.point(from), objectFromReference.point(goal),
                                 objectFromReference.scale * distance, place))
        return false;
    place = placed->referenceFromObject.point(place);
    return true;
}

double NearShapes::nearest(const glm::dvec3& p, double reach) const noexcept {
    double least = INFINITY;
    (void)eachNear(p, reach, [&](int, const FeatureDistance& d) { least = std::min(least, d.distance); });
    return least;
}

} // namespace touchstone
