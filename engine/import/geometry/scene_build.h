#pragma once
// Builds the meshes and places them in the scene.

#include "engine/import/geometry/gltf_nodes.h"
#include "engine/import/materials/gltf_materials.h"

namespace touchstone {

/// Builds every mesh of the file and places those of the shown nodes: fills scene.meshes and scene.instances.
/// Expects scene.nodes. A mesh becomes several where its nodes have different morph weights or skins, or
/// colliders assign them different physics materials.
void buildMeshesAndInstances(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                             MaterialTable& materials, Scene& scene);

/// Bounds over the instances' vertices in the static pose. Fails if they are not finite.
[[nodiscard]] Bounds sceneBounds(const ImportContext& context, const Scene& scene);

} // namespace touchstone
