#pragma once
// The zero of a field as triangles, from OpenVDB's dual contouring. Not for the servo thread.

#include "engine/grid/sparse_grid.h"
#include "haptics/shape/field/field_grid.h"

#include <cstdint>
#include <vector>

namespace touchstone {

/// The least and the greatest of the four cells about the edge of the grid that a quad of SparseGrid::zero is
/// dual to. The edge begins at the low corner of the greatest one.
struct QuadCells {
    glm::ivec3 low, high;
};
[[nodiscard]] QuadCells cellsOf(const GridFaces& faces, const GridFaces::Quad& quad);

struct FieldFaces {
    std::vector<glm::dvec3> vertices; ///< grid coordinates
    std::vector<uint32_t> corners;    ///< 3 a triangle, counter-clockwise from outside
};

/// What SparseGrid::zero made of the field's nodes, whose grid coordinates are its index space, without
/// adaptivity. It puts a vertex amid the places where the surface crosses the edges of a cell: off the
/// surface by up to two thirds of a voxel at the tip of a spike, and beside every crease that a tool leaves.
/// Here vertices lie on the zero of their cells' polynomials, or as near to it as their cells go, and a quad
/// is cut along the diagonal nearer to the crossing of its own edge, or takes that as a fifth vertex where
/// both pass it at more than a twentieth of a voxel. A quad with a vertex on a face of its cell is cut along
/// its first diagonal: floats do not tell its edge.
[[nodiscard]] FieldFaces facesOf(const FieldGrid& field, const GridFaces& made);

} // namespace touchstone
