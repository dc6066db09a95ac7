#pragma once
// What the proxy solver asks of an object that is no triangle mesh.

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace touchstone {

/// A place on a shape, as the shape numbers them: opaque to the solver. A mesh's features are its triangles.
using FeatureId = uint32_t;

/// A feature seen from a point: the plane through `closest` with the unit normal `gradient` bounds it to
/// first order.
struct FeatureDistance {
    double distance = 0.0;    ///< negative behind the surface
    glm::dvec3 gradient{0.0}; ///< unit, from the surface to the point
    glm::dvec3 closest{0.0};
    FeatureId feature = 0;
};

/// Geometry in an object frame whose unit is about the size of the object. Immutable while a servo reads it.
/// Every function is called on the servo: bounded, no allocation, no lock, no throw. Distances are signed and
/// good to 1e-13: the solver rests at a gap of 1e-12 and takes what is within 2e-12 for touched (contact.h).
class Shape {
  public:
    virtual ~Shape() = default;

    /// Time of impact in [0, limit] (fraction of `motion`) of a ball of `radius` that starts at `centre`;
    /// `limit` where it stays free. The place where it stops is within 1e-13 of touching. A ball that is
    /// nearer than `radius` (at least 0) may move away, and along the surface to a slope of 1e-13; it stops
    /// at 0 where it would come nearer still.
    [[nodiscard]] virtual double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                                       double limit) const noexcept = 0;

    /// Writes the features within `reach` of `point`, all behind the surface among them, into `found`, the
    /// nearest first, each once; their number, also where `found` has no room for all.
    [[nodiscard]] virtual size_t near(const glm::dvec3& point, double reach,
                                      std::span<FeatureDistance> found) const noexcept = 0;

    /// One feature seen from any point.
    [[nodiscard]] virtual FeatureDistance distanceFrom(FeatureId feature,
                                                       const glm::dvec3& point) const noexcept = 0;

    /// Unit outward normal that force shading follows at `point` of a feature; zero where there is none
    /// besides the true one.
    [[nodiscard]] virtual glm::dvec3 shadingNormal(FeatureId feature,
                                                   const glm::dvec3& point) const noexcept = 0;

    /// False where shadingNormal is zero everywhere.
    [[nodiscard]] virtual bool hasShadingNormals() const noexcept = 0;

    /// True where touch may not begin.
    [[nodiscard]] virtual bool contains(const glm::dvec3& point) const noexcept = 0;

    /// Radius about the object's origin that holds all of it.
    [[nodiscard]] virtual double boundingRadius() const noexcept = 0;

    /// Tells this geometry from every other, for recordings.
    [[nodiscard]] virtual uint64_t identity() const noexcept = 0;
};

} // namespace touchstone
