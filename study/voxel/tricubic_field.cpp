#include "study/voxel/tricubic_field.h"

#include <array>

namespace touchstone::study {

namespace {

using SplineWeights = std::array<double, 4>;

/// Of the nodes at -1, 0, 1, 2 for u in 0..1 (E. Catmull and R. Rom, A class of local interpolating splines,
/// 1974; tension 1/2).
SplineWeights splineWeights(double u) noexcept {
    const double u2 = u * u, u3 = u2 * u;
    return {0.5 * (-u3 + 2.0 * u2 - u), 0.5 * (3.0 * u3 - 5.0 * u2 + 2.0), 0.5 * (-3.0 * u3 + 4.0 * u2 + u),
            0.5 * (u3 - u2)};
}

SplineWeights splineSlopes(double u) noexcept {
    const double u2 = u * u;
    return {0.5 * (-3.0 * u2 + 4.0 * u - 1.0), 0.5 * (9.0 * u2 - 10.0 * u), 0.5 * (-9.0 * u2 + 8.0 * u + 1.0),
            0.5 * (3.0 * u2 - 2.0 * u)};
}

/// A place in the grid.
struct GridSpot {
    glm::ivec3 cell;
    glm::dvec3 u;
    double beyond = 0.0; ///< distance from the grid, object units
};

GridSpot spotAt(const FieldGrid& grid, const glm::dvec3& point) noexcept {
    const glm::dvec3 at = grid.gridFromObject(point);
    const glm::dvec3 near = glm::clamp(at, glm::dvec3(0.0), glm::dvec3(grid.layout().cells));
    GridSpot spot{.cell = grid.cellAt(near), .u = {}};
    spot.u = glm::clamp(near - glm::dvec3(spot.cell), 0.0, 1.0);
    spot.beyond = grid.layout().voxel * glm::length(at - near);
    return spot;
}

/// The sum over the 64 nodes; nodes beyond the border repeat it.
double splineSum(const FieldGrid& grid, const glm::ivec3& cell, const SplineWeights& x,
                 const SplineWeights& y, const SplineWeights& z) noexcept {
    double all = 0.0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            double row = 0.0;
            for (int i = 0; i < 4; ++i) {
                const glm::ivec3 node =
                    glm::clamp(cell + glm::ivec3(i - 1, j - 1, k - 1), glm::ivec3(0), grid.layout().cells);
                row += x[static_cast<size_t>(i)] * grid.node(node);
            }
            all += y[static_cast<size_t>(j)] * z[static_cast<size_t>(k)] * row;
        }
    return all;
}

} // namespace

double TricubicField::value(const glm::dvec3& point) const noexcept {
    const FieldGrid& grid = field_->grid();
    const GridSpot spot = spotAt(grid, point);
    return splineSum(grid, spot.cell, splineWeights(spot.u.x), splineWeights(spot.u.y),
                     splineWeights(spot.u.z)) +
           spot.beyond;
}

glm::dvec3 TricubicField::gradient(const glm::dvec3& point) const noexcept {
    const FieldGrid& grid = field_->grid();
    const GridSpot spot = spotAt(grid, point);
    const SplineWeights x = splineWeights(spot.u.x), y = splineWeights(spot.u.y), z = splineWeights(spot.u.z);
    return glm::dvec3(splineSum(grid, spot.cell, splineSlopes(spot.u.x), y, z),
                      splineSum(grid, spot.cell, x, splineSlopes(spot.u.y), z),
                      splineSum(grid, spot.cell, x, y, splineSlopes(spot.u.z))) /
           grid.layout().voxel;
}

} // namespace touchstone::study
