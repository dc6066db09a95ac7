#pragma once
// A distance field as a shape: the proxy's ball against an isosurface [002], swept.

#include "haptics/shape/field/field_grid.h"
#include "haptics/shape/shape.h"

#include <memory>
#include <utility>

namespace touchstone {

class FieldColors; // haptics/shape/field/field_colors.h

/// A ball of radius r touches where f at its centre is r: it rolls on the isosurface of that level, which is
/// the surface's offset as far as f is a distance. Features are cells, numbered by the grid. Where several
/// cells meet in a concave kink each holds the proxy with its own plane; at a convex kink only the cell that
/// contains the proxy does, since its neighbours lie above their continuation there.
///
/// f tells distances up to FieldGrid::outside(): a ball with a larger radius would touch the grid's box
/// instead.
class FieldShape final : public PotentialShape {
  public:
    /// Object units: a ball stops this near to contact (Shape::sweep).
    static constexpr double kTouch = 5e-14;

    /// Object frame with the unit of the grid's. Throws Error where the field is nowhere negative.
    explicit FieldShape(std::shared_ptr<const FieldGrid> grid);

    [[nodiscard]] const FieldGrid& grid() const noexcept { return *grid_; }
    [[nodiscard]] const std::shared_ptr<const FieldGrid>& sharedGrid() const noexcept { return grid_; }
    /// Of a painted surface, for the eye; null without. Touch does not read them.
    [[nodiscard]] const std::shared_ptr<const FieldColors>& colors() const noexcept { return colors_; }
    void setColors(std::shared_ptr<const FieldColors> colors) noexcept { colors_ = std::move(colors); }
    [[nodiscard]] double value(const glm::dvec3& point) const noexcept override;
    [[nodiscard]] glm::dvec3 gradient(const glm::dvec3& point) const noexcept override;
    [[nodiscard]] double lipschitz() const noexcept override { return grid_->lipschitz(); }
    [[nodiscard]] double voxel() const noexcept override { return grid_->layout().voxel; }

    [[nodiscard]] double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                               double limit) const noexcept override;
    [[nodiscard]] size_t near(const glm::dvec3& point, double reach,
                              std::span<FeatureDistance> found) const noexcept override;
    [[nodiscard]] FeatureDistance distanceFrom(FeatureId feature,
                                               const glm::dvec3& point) const noexcept override;
    /// False, too, in a kink between cells, where no smooth piece holds the ball alone.
    [[nodiscard]] bool restNear(const glm::dvec3& from, const glm::dvec3& goal, double distance,
                                glm::dvec3& place) const noexcept override;
    /// The direction of `gradient` [002 eqs. 1, 2].
    [[nodiscard]] glm::dvec3 shadingNormal(FeatureId feature,
                                           const glm::dvec3& point) const noexcept override;
    [[nodiscard]] double boundingRadius() const noexcept override { return boundingRadius_; }
    [[nodiscard]] uint64_t memoryBytes() const noexcept override { return grid_->memoryBytes(); }
    [[nodiscard]] uint64_t identity() const noexcept override { return grid_->hash(); }

  private:
    struct Place;
    [[nodiscard]] Place at(const glm::dvec3& point) const noexcept;
    [[nodiscard]] FeatureDistance seen(const FieldCell& cell, const glm::ivec3& index,
                                       const glm::dvec3& point) const noexcept;
    [[nodiscard]] double sweepOutside(const glm::dvec3& centre, const glm::dvec3& motion, double level,
                                      double from, double to) const noexcept;
    [[nodiscard]] double sweepInside(const glm::dvec3& centre, const glm::dvec3& motion, double level,
                                     double from, double to) const noexcept;

    std::shared_ptr<const FieldGrid> grid_;
    std::shared_ptr<const FieldColors> colors_;
    double boundingRadius_ = 0.0;
};

} // namespace touchstone
