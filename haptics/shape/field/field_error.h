#pragma once
// How far a distance field's surface is from the triangles that it is made of, and the field that is near
// enough. Not for the servo thread.

#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/mesh_to_field.h"

namespace touchstone {

/// The largest distance of the field's surface from places on the mesh, to first order |f| / |grad f|, object
/// units: along edges every half voxel (1,024 places of an edge at most), inside of triangles every voxel (64
/// rows of a triangle at most). An open mesh lies in the middle of its shell, a voxel from the surface.
[[nodiscard]] double fieldErrorOf(const HapticObject& mesh, const FieldShape& field);

inline constexpr double kCoarsestWithin =
    1.0 / 64.0; ///< object units: the voxel that fieldWithin begins with

struct FittedField {
    std::shared_ptr<const FieldGrid> grid;
    double error = 0.0; ///< fieldErrorOf it
};

/// The field with the coarsest of the voxels kCoarsestWithin, 1/91, 1/128, ... of the object (each a step of
/// sqrt(2)) that is within `error` of the mesh; `request.voxel` is not read. Where kMostFieldCells do not
/// suffice: the nearest one, or that of the usual voxel where no field comes near `error`, whose own error is
/// larger then. Throws as fieldOfMesh does.
[[nodiscard]] FittedField fieldWithin(const HapticObject& mesh, FieldRequest request, double error,
                                      const FieldCache& cache, const Progress& progress = {});

} // namespace touchstone
