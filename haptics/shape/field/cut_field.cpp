#include "haptics/shape/field/cut_field.h"

#include "engine/core/checksum.h"

#include <algorithm>

namespace touchstone {

double CutField::value(const glm::dvec3& point) const noexcept {
    return std::max(field_->value(point), beyond(point));
}

glm::dvec3 CutField::gradient(const glm::dvec3& point) const noexcept {
    return beyond(point) > field_->value(point) ? normal_ : field_->gradient(point);
}

double CutField::lipschitz() const noexcept {
    return std::max(field_->lipschitz(), 1.0);
}

/// The ball meets the body where both f and d are down to the level: first before the plane, in closed form,
/// then within the half-space by the field's own sweep, and no longer once it has left that again.
double CutField::sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                       double limit) const noexcept {
    if (!(glm::dot(motion, motion) > 0.0))
        return limit;
    const double d = beyond(centre), rate = glm::dot(normal_, motion);
    const double stands = std::min(radius, std::max(field_->value(centre), d)),
                 level = stands - FieldShape::kTouch;
    if (d <= level) {
        const double met = field_->sweep(centre, stands, motion, limit);
        return rate > 0.0 && d + met * rate > level ? limit : met;
    }
    const double enters = rate < 0.0 ? (level - d) / rate : limit;
    if (enters >= limit)
        return limit;
    const glm::dvec3 at = centre + enters * motion;
    if (field_->value(at) <= level)
        return enters;
    return std::min(limit, enters + field_->sweep(at, stands, motion, limit - enters));
}

size_t CutField::near(const glm::dvec3& point, double reach,
                      std::span<FeatureDistance> found) const noexcept {
    const double d = beyond(point);
    if (d > reach)
        return 0;
    if (field_->value(point) >= d)
        return field_->near(point, reach, found);
    if (!found.empty())
        found[0] = distanceFrom(kFace, point);
    return 1;
}

FeatureDistance CutField::distanceFrom(FeatureId feature, const glm::dvec3& point) const noexcept {
    if (feature != kFace)
        return field_->distanceFrom(feature, point);
    const double d = beyond(point);
    return {.distance = d, .gradient = normal_, .closest = point - d * normal_, .feature = kFace};
}

glm::dvec3 CutField::shadingNormal(FeatureId feature, const glm::dvec3& point) const noexcept {
    return feature == kFace ? normal_ : field_->shadingNormal(feature, point);
}

uint64_t CutField::identity() const noexcept {
    Hash64 hash;
    hash.add(field_->identity());
    for (int axis = 0; axis < 3; ++axis)
        hash.add(normal_[axis]);
    hash.add(offset_);
    return hash.value();
}

const FieldShape* wholeField(const Shape* shape) noexcept {
    if (const auto* const cut = dynamic_cast<const CutField*>(shape))
        return &cut->field();
    return dynamic_cast<const FieldShape*>(shape);
}

} // namespace touchstone
