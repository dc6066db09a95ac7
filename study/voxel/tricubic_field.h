#pragma once
// A field read by Catmull-Rom splines instead of trilinearly: to compare with.

#include "haptics/shape/field/field_shape.h"

#include <memory>

namespace touchstone::study {

/// The potential is the tensor product of Catmull-Rom splines between the 4^3 nodes about a place: C1, exact
/// for quadratic polynomials, its error falls with the cube of the voxel (with the trilinear one's square).
/// For contact=virtualPoint, whose gradient is the spline's own; the sweep's questions go to the trilinear
/// field. Outside of the nodes about the surface (next to where the field is flat) splines overshoot the
/// flat value by less than an eighth of a node's difference.
class TricubicField final : public PotentialShape {
  public:
    explicit TricubicField(std::shared_ptr<const FieldShape> field) : field_(std::move(field)) {}

    [[nodiscard]] double value(const glm::dvec3& point) const noexcept override;
    [[nodiscard]] glm::dvec3 gradient(const glm::dvec3& point) const noexcept override;
    /// A derivative of the spline is at most 3/2 of the largest difference of nodes, the weights of each
    /// other axis add up to at most 5/4, and there are three axes: sqrt(3) (3/2) (5/4)^2 < 4.06.
    [[nodiscard]] double lipschitz() const noexcept override { return 4.06 * field_->lipschitz(); }
    [[nodiscard]] double voxel() const noexcept override { return field_->voxel(); }

    [[nodiscard]] double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                               double limit) const noexcept override {
        return field_->sweep(centre, radius, motion, limit);
    }
    [[nodiscard]] size_t near(const glm::dvec3& point, double reach,
                              std::span<FeatureDistance> found) const noexcept override {
        return field_->near(point, reach, found);
    }
    [[nodiscard]] FeatureDistance distanceFrom(FeatureId feature,
                                               const glm::dvec3& point) const noexcept override {
        return field_->distanceFrom(feature, point);
    }
    [[nodiscard]] glm::dvec3 shadingNormal(FeatureId feature,
                                           const glm::dvec3& point) const noexcept override {
        return field_->shadingNormal(feature, point);
    }
    [[nodiscard]] double boundingRadius() const noexcept override { return field_->boundingRadius(); }
    [[nodiscard]] uint64_t memoryBytes() const noexcept override { return field_->memoryBytes(); }
    [[nodiscard]] uint64_t identity() const noexcept override { return field_->identity() + 1; }

  private:
    std::shared_ptr<const FieldShape> field_;
};

} // namespace touchstone::study
