#pragma once

#include "engine/import/mesh_file/flat_meshes.h"

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

/// A GLB with these meshes, a node each, and their materials: grey, no metal, both sides drawn, and nothing
/// else stated. `generator` is the text of its asset. Throws Error where it would be larger than a GLB can
/// be.
[[nodiscard]] std::vector<uint8_t> glbOf(const FlatMeshes& meshes, const std::string& generator,
                                         const std::string& shownAs);

} // namespace touchstone
