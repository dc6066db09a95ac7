#pragma once
// The queries of the proxy solver to an object that is not a triangle mesh.

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace touchstone {

/// A feature of a shape, numbered by the shape: opaque to the solver. A mesh's features are its triangles.
using FeatureId = uint32_t;

/// A feature seen from a point: the plane through `closest` with the unit normal `gradient` bounds it to
/// first order.
struct FeatureDistance {
    double distance = 0.0;    ///< negative behind the surface
    glm::dvec3 gradient{0.0}; ///< unit, from the surface to the point
    glm::dvec3 closest{0.0};
    FeatureId feature = 0;
};

/// A potential f whose zero is a shape's surface, negative inside [002 §3.1]. The shape's frame and unit.
class PotentialField {
  public:
    virtual ~PotentialField() = default;
    [[nodiscard]] virtual double value(const glm::dvec3& point) const noexcept = 0;
    /// The gradients at the eight nodes of the cell, interpolated [002 §3.2]: unlike the gradient of f it is
    /// continuous.
    [[nodiscard]] virtual glm::dvec3 gradient(const glm::dvec3& point) const noexcept = 0;
    /// At least |f(a) - f(b)| / |a - b| for all a, b.
    [[nodiscard]] virtual double lipschitz() const noexcept = 0;
    /// Edge of a cell.
    [[nodiscard]] virtual double voxel() const noexcept = 0;
};

/// Geometry in an object frame whose unit is about the size of the object. Immutable while a servo reads it.
/// Every function runs on the servo thread: bounded, no allocation, no lock, no throw. Distances are signed
/// and accurate to 1e-13: the solver rests at a gap of 1e-12 and counts what is within 2e-12 as contact
/// (contact.h).
class Shape {
  public:
    virtual ~Shape() = default;

    /// Time of impact in [0, limit] (fraction of `motion`) of a ball of `radius` that starts at `centre`;
    /// `limit` where it stays free. It stops within 1e-13 of contact. A ball that is nearer than `radius` (at
    /// least 0) may move away, and along the surface to a slope of 1e-13; it stops at 0 where it would come
    /// nearer still.
    [[nodiscard]] virtual double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                                       double limit) const noexcept = 0;

    /// Writes the features within `reach` of `point`, including all behind the surface, into `found`, the
    /// nearest first, each once; returns their number, also where `found` has no room for all.
    [[nodiscard]] virtual size_t near(const glm::dvec3& point, double reach,
                                      std::span<FeatureDistance> found) const noexcept = 0;

    /// One feature seen from any point.
    [[nodiscard]] virtual FeatureDistance distanceFrom(FeatureId feature,
                                                       const glm::dvec3& point) const noexcept = 0;

    /// Where a ball whose centre is pulled straight to `goal` rests at `distance` from the surface, looked
    /// for from `from`: the place nearest to the goal among those around it. False where the shape knows
    /// none; then, and where the way to it is not free, the solver finds it move by move.
    [[nodiscard]] virtual bool restNear(const glm::dvec3& /*from*/, const glm::dvec3& /*goal*/,
                                        double /*distance*/, glm::dvec3& /*place*/) const noexcept {
        return false;
    }

    /// Unit outward normal for force shading at `point` of a feature; zero where there is only the true one.
    [[nodiscard]] virtual glm::dvec3 shadingNormal(FeatureId feature,
                                                   const glm::dvec3& point) const noexcept = 0;

    /// False where shadingNormal is zero everywhere.
    [[nodiscard]] virtual bool hasShadingNormals() const noexcept = 0;

    /// True where touch may not begin.
    [[nodiscard]] virtual bool contains(const glm::dvec3& point) const noexcept = 0;

    /// Radius of a sphere about the object's origin that contains the object.
    [[nodiscard]] virtual double boundingRadius() const noexcept = 0;

    /// Null where the shape is no potential field; lives as long as the shape.
    [[nodiscard]] virtual const PotentialField* potential() const noexcept { return nullptr; }

    /// What the shape keeps for the servo.
    [[nodiscard]] virtual uint64_t memoryBytes() const noexcept = 0;

    /// Distinguishes this geometry from every other, for recordings.
    [[nodiscard]] virtual uint64_t identity() const noexcept = 0;
};

/// The inside of a potential field.
class PotentialShape : public Shape, public PotentialField {
  public:
    [[nodiscard]] const PotentialField* potential() const noexcept final { return this; }
    [[nodiscard]] bool hasShadingNormals() const noexcept final { return true; }
    [[nodiscard]] bool contains(const glm::dvec3& point) const noexcept final { return value(point) < 0.0; }
};

} // namespace touchstone
