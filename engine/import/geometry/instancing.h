#pragma once
// EXT_mesh_gpu_instancing: many copies of the mesh of one node.

#include "engine/import/materials/gltf_document.h"

#include <optional>
#include <vector>

namespace touchstone {

/// nodeFromMesh of every copy of the node's mesh (translation * rotation * scale); nothing if the node has no
/// such extension or no attribute of it that places copies. Throws Error for attributes of other types and
/// counts, values that are not finite, and more copies than an import may make (import_context.h); warns of
/// rotations without a direction, which turn nothing. `before` copies are those that other nodes of the file
/// made. Spends geometry memory.
[[nodiscard]] std::optional<std::vector<glm::dmat4>>
readCopies(ImportContext& context, const GltfDocument& document, size_t gltfNode, uint64_t before);

} // namespace touchstone
