#pragma once

#include "engine/import/file/import_context.h"
#include "engine/volume/volume.h"

#include <cstdint>
#include <vector>

namespace touchstone {

/// A GLB with the surface of a volume at `iso`, for the eye: one node, mesh and material, as a mesh file
/// becomes (flat_glb.h). Throws Error and Cancelled.
[[nodiscard]] std::vector<uint8_t> glbOfVolume(ImportContext& context, const Volume& volume, double iso);

} // namespace touchstone
