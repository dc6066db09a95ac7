#pragma once
// EXT_mesh_gpu_instancing: many copies of the mesh of one node.

#include "engine/import/materials/gltf_document.h"

#include <optional>
#include <vector>

namespace touchstone {

/// nodeFromMesh of every copy of the node's mesh (translation * rotation * scale); empty if the node lacks
/// the extension or any attribute of it that places copies. Throws Error for attributes of other types and
/// counts, values that are not finite, and more copies than an import may make (import_context.h); warns of
/// rotations without a direction, which count as the identity. `before`: the copies that other nodes of the
/// file made. Spends geometry memory.
[[nodiscard]] std::optional<std::vector<glm::dmat4>>
readCopies(ImportContext& context, const GltfDocument& document, size_t gltfNode, uint64_t before);

} // namespace touchstone
