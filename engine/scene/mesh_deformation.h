#pragma once
// What moves the vertices of a mesh: a skin, morph targets, or both, kept only where an animation of the file
// drives them; or forces.

#include "engine/scene/animation.h"
#include "engine/scene/scene.h"
#include "engine/scene/soft_body.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace touchstone {

/// Displacements of one morph target by vertex; an array is empty where the target has none.
struct MorphTarget {
    std::vector<glm::vec3> positions, normals;
};

/// The vertices of a primitive as in the file, before morph targets and skin (glTF 2.0, sections 3.7.2.2 and
/// 3.7.3). Every joint, influence and target exists; all numbers are finite.
struct MeshDeformation {
    std::vector<glm::vec3> positions; ///< m, mesh frame
    std::vector<glm::vec3> normals;   ///< unit; empty where the file has none
    std::vector<MorphTarget> targets;
    std::vector<double> weights; ///< of the static pose, one per target
    int weightsNode = -1;        ///< Scene::nodes: whose channel of weights drives `targets`; -1: none
    std::vector<int> joints;     ///< Scene::nodes; empty: no skin
    std::vector<glm::mat4> jointFromMesh; ///< inverse bind matrices; empty: the identity
    size_t perVertex = 0;                 ///< influences of a vertex
    std::vector<uint32_t> vertexJoints;   ///< perVertex each, below joints.size()
    std::vector<float> vertexWeights;     ///< perVertex each, at least 0, with a positive sum
    glm::dvec3 sceneFromSkin{0.0};        ///< m: a skinned mesh's frame is the scene's, moved here
    std::shared_ptr<const SoftBody> soft; ///< a soft body: nothing of the above moves it

    [[nodiscard]] uint64_t memoryBytes() const;
    /// True where `animation` moves a vertex. `moved`: movedNodes.
    [[nodiscard]] bool drivenBy(const Animation& animation, const std::vector<bool>& moved) const;
};

[[nodiscard]] bool hasSoftBodies(const Scene& scene);

/// Evaluates a deformation in double. The constructor allocates; nothing else allocates, locks or throws.
class DeformedVertices {
  public:
    explicit DeformedVertices(const MeshDeformation& deformation);

    /// Takes over joints and weights of `pose` (of the same scene) for the calls that follow.
    void pose(const ScenePose& pose) noexcept;
    /// Vertex of the deformation, mesh frame.
    [[nodiscard]] glm::dvec3 position(size_t vertex) const noexcept;
    /// A vertex with its surroundings.
    struct Frame {
        glm::dvec3 position{0.0};
        glm::dvec3 normal{0.0};  ///< unit; zero where it has none
        glm::dmat3 linear{1.0};  ///< by which the skin turns directions in the surface
        double handedness = 1.0; ///< -1 where the skin mirrors
    };
    [[nodiscard]] Frame frame(size_t vertex) const noexcept;

  private:
    [[nodiscard]] glm::dvec3 morphed(size_t vertex) const noexcept;
    [[nodiscard]] glm::dmat4 skinMatrix(size_t vertex) const noexcept;

    const MeshDeformation* deformation_;
    std::vector<glm::dmat4> meshFromVertex_; // by joint
    std::vector<double> weights_;
};

/// The vertex arrays of a deforming mesh in a pose, for the eye: as many entries as the mesh's own, in its
/// frame.
struct DrawnVertices {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents; ///< without displacements of their own
};
/// `rest`: the same deformation in the static pose, whose tangents the mesh has. Normals of a mesh without
/// any in the file are those of its triangles. Allocates where `drawn` is of another size.
void deform(const Mesh& mesh, const DeformedVertices& vertices, const DeformedVertices& rest,
            DrawnVertices& drawn);

} // namespace touchstone
