#pragma once
// Places on the surface in a window: where the trilinear values are zero.

#include "haptics/shape/field/field_cell.h"
#include "haptics/shape/field/sculpt/field_window.h"

#include <glm/glm.hpp>

#include <optional>

namespace touchstone {

/// Reads FieldWindow::value. Places and distances in voxels.
class ClosestPoints {
  public:
    explicit ClosestPoints(const FieldWindow& window) : window_(window) {}

    /// Whether the surface passes between the node and one of its 26 neighbours: a cell has both signs.
    /// False at the window's border.
    [[nodiscard]] bool near(const glm::ivec3& node) const;
    /// The nearest place that is found from a node that is `near`: of those on the 26 ways to its neighbours
    /// and along its gradient, and from there along the surface.
    [[nodiscard]] glm::dvec3 fromNear(const glm::ivec3& node) const;
    /// A place of the surface that is nearer to `from` than `point`, which is one: along the tangent plane
    /// to the foot of `from`, and back by Newton's method. `point` where none is found.
    [[nodiscard]] glm::dvec3 slid(const glm::dvec3& from, const glm::dvec3& point) const;
    /// The nearest place that Newton's method finds from one that is nearly on the surface; none where it
    /// does not converge, or goes farther than a voxel.
    [[nodiscard]] std::optional<glm::dvec3> onSurface(const glm::dvec3& point) const;
    /// Central differences of the values before the dab; zero at the window's border.
    [[nodiscard]] glm::dvec3 gradientBefore(const glm::ivec3& node) const;

  private:
    [[nodiscard]] bool border(const glm::ivec3& node) const;
    struct Cell {
        glm::ivec3 at{-1};
        FieldCell values;
        bool crossed = false; ///< by the surface
    };
    /// The cell of a place, read where it is not `cell` already: of the grid where the window holds no
    /// values.
    void find(const glm::dvec3& place, Cell& cell) const;
    [[nodiscard]] double valueAt(const glm::dvec3& place, Cell& cell) const;
    [[nodiscard]] double along(const glm::ivec3& node, const glm::dvec3& direction, double most) const;

    const FieldWindow& window_;
};

} // namespace touchstone
