#pragma once
// The meshes of a scene: one glTF mesh becomes several where its nodes show it in different poses or with
// different physics materials.

#include "engine/import/geometry/skin.h"
#include "engine/import/materials/gltf_materials.h"

#include <compare>
#include <map>
#include <optional>
#include <vector>

namespace touchstone {

/// The properties by which nodes show a glTF mesh differently.
struct ShownMesh {
    size_t gltfMesh = 0;
    int skin = -1;               ///< of the file; -1: rigid
    std::vector<double> weights; ///< of the morph targets (morphWeights)
    int weightsNode = -1;        ///< Scene::nodes: whose animation drives them; -1: none does
    int physics = -1;            ///< the node's physics material; -1: none

    [[nodiscard]] std::partial_ordering operator<=>(const ShownMesh&) const = default;
};

/// One primitive of a shown mesh.
struct MeshVariant {
    int mesh = -1; ///< index into Scene::meshes
    /// The origin of a posed skin's frame in the scene; empty for a mesh that follows its node.
    std::optional<glm::dvec3> origin;
};

class MeshVariants {
  public:
    /// Fills scene.meshes. Refers to all of its arguments, which outlive it.
    MeshVariants(ImportContext& context, const GltfDocument& document, MaterialTable& materials,
                 SkinPoses& skins, Scene& scene)
        : context_(context), document_(document), materials_(materials), skins_(skins), scene_(scene) {}

    /// One entry for each primitive that has something to draw. Built on first use.
    const std::vector<MeshVariant>& get(const ShownMesh& shown);

    /// True if some variant of the mesh was requested.
    [[nodiscard]] bool has(size_t gltfMesh) const { return asked_[gltfMesh]; }

  private:
    using Made = std::map<ShownMesh, std::vector<MeshVariant>>;

    [[nodiscard]] int materialFor(const ShownMesh& shown, size_t primitive);
    [[nodiscard]] const std::vector<MeshVariant>* sameShape(Made::const_iterator found) const;
    [[nodiscard]] std::vector<MeshVariant> buildAll(const ShownMesh& shown);
    [[nodiscard]] std::vector<MeshVariant> copyAll(const ShownMesh& shown,
                                                   const std::vector<MeshVariant>& from);
    void keep(Mesh mesh, size_t primitive);

    ImportContext& context_;
    const GltfDocument& document_;
    MaterialTable& materials_;
    SkinPoses& skins_;
    Scene& scene_;
    Made made_;
    std::vector<size_t> primitiveOf_; ///< by scene mesh
    std::vector<bool> asked_ = std::vector<bool>(document_.model.meshes.size(), false);
};

} // namespace touchstone
