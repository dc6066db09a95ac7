#pragma once
// Skins in the pose of their joints in the file, and what is needed to move them (glTF 2.0, section 3.7.3):
// the weighted mean of sceneFromJoint * inverseBind transforms the vertices of a skinned mesh to the scene,
// and its node's transform is ignored. Reading (SkinPoses, readInfluences) and posing (poseVertices) are
// separate, so that a skin can be posed again.

#include "engine/import/geometry/gltf_nodes.h"
#include "engine/import/geometry/vertex_attributes.h"

#include <map>
#include <span>
#include <vector>

namespace touchstone {

/// A skin with its joints in place.
struct SkinPose {
    std::string place;                     ///< "skins[2]"
    std::vector<glm::dmat4> sceneFromMesh; ///< by joint; not finite where the file's numbers are not
    std::vector<int> joints;               ///< Scene::nodes
    std::vector<glm::mat4> jointFromMesh;  ///< by joint; empty: the identity
    bool driven = false;                   ///< an animation of the file moves a joint
};

/// The skins of a file, each read on first use.
class SkinPoses {
  public:
    /// `nodes` are those of the forest, which may have been moved out of it; `sceneFromNode` has the same
    /// order, as has `driven`: whether an animation of the file moves the node. Refers to all of its
    /// arguments, which outlive it.
    SkinPoses(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
              std::span<const Node> nodes, std::span<const glm::dmat4> sceneFromNode,
              const std::vector<bool>& driven)
        : context_(context), document_(document), forest_(forest), nodes_(nodes),
          sceneFromNode_(sceneFromNode), driven_(driven) {}

    /// skins[skin] of the file. Missing inverse bind matrices are the identity. Throws Error where there are
    /// fewer of them than joints; warns of joints outside the scene or without a common root and of matrices
    /// that are not affine (their last row counts as 0, 0, 0, 1). Spends geometry memory.
    [[nodiscard]] const SkinPose& get(size_t skin);

  private:
    [[nodiscard]] std::vector<glm::mat4> inverseBinds(const nlohmann::json& skin,
                                                      const std::string& place) const;
    void checkJoints(const std::vector<size_t>& joints, const std::string& place);

    ImportContext& context_;
    const GltfDocument& document_;
    const NodeForest& forest_;
    std::span<const Node> nodes_;
    std::span<const glm::dmat4> sceneFromNode_;
    const std::vector<bool>& driven_;
    std::vector<int> rootOf_; ///< by index in `nodes`; computed on first use
    std::map<size_t, SkinPose> made_;
};

/// The joints that move a vertex, with their weights: `perVertex` pairs a vertex.
struct VertexInfluences {
    size_t perVertex = 0;
    std::vector<uint32_t> joints; ///< less than the skin's number of joints where the weight is not 0
    std::vector<float> weights;   ///< at least 0; their sum over a vertex is positive and not always 1
};

/// JOINTS_n and WEIGHTS_n of a primitive; empty, with a warning, if it has neither. Negative weights count as
/// 0 and a vertex whose weights are all 0 follows its first joint, both with a warning, as do weights whose
/// sum is not 1. Throws Error for joints that the skin does not have and for half a pair of attributes.
/// Spends geometry memory.
[[nodiscard]] std::optional<VertexInfluences>
readInfluences(ImportContext& context, const GltfDocument& document, const tinygltf::Primitive& primitive,
               DracoPrimitive* draco, const SkinPose& skin, size_t vertexCount, const std::string& place);

/// Poses the vertices of `mesh`, which are those of the file, and returns the origin of its new frame in the
/// scene: sceneFromMesh is the translation by it. It is the centre of the drawn vertices, so that a float
/// holds a vertex to 6e-8 of the object wherever the joints are. Normals transform by the cofactor matrix,
/// tangents by the matrix; both are unit afterwards, normals that vanish are 0. Where joints mirror,
/// triangles are reversed and tangents change handedness. Throws Error for vertices that are not finite.
/// Spends geometry memory.
[[nodiscard]] glm::dvec3 poseVertices(ImportContext& context, const VertexInfluences& influences,
                                      const SkinPose& skin, const std::string& place, Mesh& mesh);

} // namespace touchstone
