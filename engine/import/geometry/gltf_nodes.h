#pragma once
// The node forest: sorted parents first, with the meshes of the shown scene.

#include "engine/import/materials/gltf_document.h"

#include <vector>

namespace touchstone {

struct NodeForest {
    std::vector<Node> nodes;     ///< parents before children
    std::vector<int> nodeOfGltf; ///< index in the file -> index in `nodes`
    std::vector<int> gltfOfNode; ///< the inverse
    std::vector<bool> shown;     ///< by index in `nodes`: belongs to the shown scene
};

/// Reads all nodes. Shown are the nodes of the file's default scene, else of its first, else (no scenes at
/// all) every node. Rotations are normalised; a zero quaternion becomes the identity with a warning.
[[nodiscard]] NodeForest readNodes(ImportContext& context, const GltfDocument& document);

} // namespace touchstone
