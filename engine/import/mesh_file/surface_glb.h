#pragma once

#include "engine/volume/volume_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

/// A GLB with one surface: a node, a mesh and a material "surface" (flat_glb.h). Throws Error where it would
/// be larger than a GLB can be.
[[nodiscard]] std::vector<uint8_t> glbOfSurface(const SurfaceMesh& surface, const std::string& name,
                                                const std::string& generator, const std::string& shownAs);

} // namespace touchstone
