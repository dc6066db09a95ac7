#pragma once

#include "engine/import/geometry/gltf_nodes.h"
#include "engine/scene/scene.h"

namespace touchstone {

/// Gives the meshes of nodes with TOUCHSTONE_soft_body a MeshDeformation whose `soft` is set. What is wrong
/// stays hard, with a warning. Expects nodes, instances, animations and physics; may add a copy of a mesh.
void readSoftBodies(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                    Scene& scene);

} // namespace touchstone
