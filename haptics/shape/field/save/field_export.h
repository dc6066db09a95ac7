#pragma once
// A field as a mesh and as an OpenVDB level set. Not for the servo thread.

#include "engine/math/similarity.h"
#include "engine/volume/volume_mesh.h"
#include "haptics/shape/field/field_colors.h"

#include <memory>
#include <string>

namespace touchstone {

/// The surface of a field by dual contouring (facesOf), with normals along the field's interpolated gradient.
/// Scene frame, m. No triangles where the field is nowhere negative. Throws Error where it would have more
/// than kMostSurfaceFaces quadrilaterals. `colors`: null where it is not painted.
[[nodiscard]] SurfaceMesh meshOfField(const std::shared_ptr<const FieldGrid>& grid,
                                      const Similarity& sceneFromObject, const FieldColors* colors = nullptr);

/// The bytes of a .vdb file with one float grid, a level set in metres whose transform places it in the
/// scene: all distances that the field tells, inside and outside; nodes at its limits are inactive.
[[nodiscard]] std::string vdbOfField(const FieldGrid& grid, const Similarity& sceneFromObject,
                                     const std::string& name);

} // namespace touchstone
