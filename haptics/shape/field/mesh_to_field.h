#pragma once
// The distance field of a mesh. Not for the servo thread. OpenVDB tells inside from outside; the distances
// are those to the nearest of all triangles.

#include "engine/core/progress.h"
#include "haptics/shape/field/field_cache.h"
#include "haptics/shape/field/field_grid.h"
#include "haptics/shape/field/field_relief.h"
#include "haptics/shape/mesh/haptic_object.h"

#include <memory>

namespace touchstone {

/// Object units.
struct FieldRequest {
    double voxel = 1.0 / 128.0;
    double inside = 0.2;   ///< distances behind the surface that the field tells: as deep as a device pushes
    double outside = 0.04; ///< before it: at least the radius of the largest proxy
    FieldRelief relief{};  ///< on the nodes: of a field that reaches at least reachOf(relief, voxel)
};

/// Negative inside a closed mesh, whichever way its triangles face; an open one, and one too thin to hold a
/// node, becomes a shell of two voxels around its triangles. Distances are those to the triangles at the
/// nodes. Throws Error where the voxel is no positive number and where the grid would have more than
/// kMostFieldCells cells (the message tells by how much the voxel is too small); Cancelled.
[[nodiscard]] std::shared_ptr<const FieldGrid>
fieldOfMesh(const HapticObject& mesh, const FieldRequest& request, const Progress& progress = {});

/// The same bits, out of `cache` where it has them; else they are built and kept there.
[[nodiscard]] std::shared_ptr<const FieldGrid> fieldOfMesh(const HapticObject& mesh,
                                                           const FieldRequest& request,
                                                           const FieldCache& cache,
                                                           const Progress& progress = {});

/// How far to both sides of the surface a field with a relief tells distances, object units; 0 without one.
[[nodiscard]] double reachOf(const FieldRelief& relief, double voxel);

/// The smallest voxel with which the mesh's field has at most kMostFieldCells cells.
[[nodiscard]] double finestVoxel(const HapticObject& mesh, double outside);

inline constexpr uint64_t kMostFieldCells = uint64_t{5} << 24;

} // namespace touchstone
