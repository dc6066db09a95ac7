#pragma once
// Converts primitives to indexed triangle lists.

#include "engine/import/geometry/skin.h"

#include <optional>
#include <span>

namespace touchstone {

/// The pose in which a node shows a mesh.
struct MeshPose {
    std::span<const double> weights; ///< of the morph targets; missing ones are 0
    const SkinPose* skin = nullptr;  ///< null: rigid
    int weightsNode = -1; ///< Scene::nodes: whose animated weights drive the morph targets; -1: none
};

/// A mesh in its pose. A skinned one is placed in the scene, with its frame at `origin`; any other in its
/// node.
struct PosedMesh {
    Mesh mesh;
    std::optional<glm::dvec3> origin;
};

/// Builds one primitive in its pose. Empty if its mode has no triangles (points, lines, no positions), with a
/// warning. Strips, fans and missing indices become lists; degenerate index triples are dropped; missing
/// normals become flat ones (vertices split); missing tangents are generated where `material` needs them. A
/// primitive without joints is rigid in any pose, with a warning. Where an animation drives it, it keeps its
/// deformation. `mesh.material` is left to the caller.
/// Throws Error for indices out of range, values that are not finite, and counts that differ.
[[nodiscard]] std::optional<PosedMesh> buildMesh(ImportContext& context, const GltfDocument& document,
                                                 size_t meshIndex, size_t primitiveIndex,
                                                 const Material& material, const MeshPose& pose);

} // namespace touchstone
