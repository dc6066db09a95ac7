#pragma once
// The part of a distance field on one side of a plane: filled, with a flat face where it is cut.

#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/shape.h"

#include <glm/glm.hpp>

#include <memory>

namespace touchstone {

/// The body of a field where dot(normal, p) <= offset. With d(p) = dot(normal, p) - offset its potential is
/// max(f, d), and as with the field a ball of radius r touches where that is r at its centre. The face is one
/// feature, FieldShape's cells are the others. The edge of the cut is convex, so that only the larger of f
/// and d holds a ball there: the other one lies above its continuation.
///
/// Over the face, where the sweep is in closed form, the place is exact to FieldShape::kTouch; elsewhere the
/// answers are the field's to the last bit.
class CutField final : public PotentialShape {
  public:
    static constexpr FeatureId kFace = ~FeatureId{0}; ///< no grid has so many cells

    /// `normal`: unit; `offset` along it from the origin. The field's frame and unit.
    CutField(std::shared_ptr<const FieldShape> field, const glm::dvec3& normal, double offset)
        : field_(std::move(field)), normal_(normal), offset_(offset) {}

    [[nodiscard]] const FieldShape& field() const noexcept { return *field_; }
    /// The same cut of another field.
    [[nodiscard]] std::shared_ptr<const CutField> of(std::shared_ptr<const FieldShape> field) const {
        return std::make_shared<CutField>(std::move(field), normal_, offset_);
    }

    [[nodiscard]] double value(const glm::dvec3& point) const noexcept override;
    [[nodiscard]] glm::dvec3 gradient(const glm::dvec3& point) const noexcept override;
    [[nodiscard]] double lipschitz() const noexcept override;
    [[nodiscard]] double voxel() const noexcept override { return field_->voxel(); }

    [[nodiscard]] double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                               double limit) const noexcept override;
    [[nodiscard]] size_t near(const glm::dvec3& point, double reach,
                              std::span<FeatureDistance> found) const noexcept override;
    [[nodiscard]] FeatureDistance distanceFrom(FeatureId feature,
                                               const glm::dvec3& point) const noexcept override;
    /// On the field, from there: a ball that the face holds rests by the first move.
    [[nodiscard]] bool restNear(const glm::dvec3& from, const glm::dvec3& goal, double distance,
                                glm::dvec3& place) const noexcept override {
        return field_->value(from) >= beyond(from) && field_->restNear(from, goal, distance, place) &&
               beyond(place) < distance;
    }
    [[nodiscard]] glm::dvec3 shadingNormal(FeatureId feature,
                                           const glm::dvec3& point) const noexcept override;
    [[nodiscard]] double boundingRadius() const noexcept override { return field_->boundingRadius(); }
    [[nodiscard]] uint64_t memoryBytes() const noexcept override { return field_->memoryBytes(); }
    [[nodiscard]] uint64_t identity() const noexcept override;

  private:
    [[nodiscard]] double beyond(const glm::dvec3& point) const noexcept {
        return glm::dot(normal_, point) - offset_;
    }

    std::shared_ptr<const FieldShape> field_;
    glm::dvec3 normal_;
    double offset_;
};

/// The field of a shape, the whole one where a plane cuts it; null for other shapes.
[[nodiscard]] const FieldShape* wholeField(const Shape* shape) noexcept;

} // namespace touchstone
