#pragma once
// The distance field of a mesh, by OpenVDB. Not for the servo thread.

#include "engine/core/progress.h"
#include "haptics/shape/field/field_grid.h"
#include "haptics/shape/mesh/haptic_object.h"

#include <memory>

namespace touchstone {

/// Object units.
struct FieldRequest {
    double voxel = 1.0 / 128.0;
    double inside = 0.2;   ///< distances behind the surface that the field tells: as deep as a device pushes
    double outside = 0.04; ///< before it: at least the radius of the largest proxy
};

/// Negative inside a closed mesh, whichever way its triangles face; an open one becomes a shell of two voxels
/// around its triangles. Distances are those to the triangles at the nodes. Throws Error where the grid would
/// have more than kMostFieldCells cells (the message names the smallest voxel that fits) and where no node is
/// inside; Cancelled.
[[nodiscard]] std::shared_ptr<const FieldGrid>
fieldOfMesh(const HapticObject& mesh, const FieldRequest& request, const Progress& progress = {});

inline constexpr uint64_t kMostFieldCells = uint64_t{1} << 30;

} // namespace touchstone
