#pragma once
// The immutable scene that rendering and touch share. Made by scene_loader.h, validated before construction.

#include "engine/core/checksum.h"
#include "engine/math/similarity.h"
#include "engine/scene/image.h"
#include "engine/scene/material.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {

struct MeshDeformation; // engine/scene/mesh_deformation.h

/// One glTF primitive in its mesh frame (model metres, float as in the file): an indexed triangle list, or
/// line segments or points, which are drawn but not felt. Of the three index arrays at most one has entries.
/// All vertex arrays have `positions.size()` entries or are empty. Indices are in range, positions finite.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< unit; from the file, else flat (`normalsFromFile` is false); empty
                                     ///< for lines and points without
    std::vector<glm::vec4> tangents; ///< xyz unit, w = +1 or -1; empty if the material needs none
    std::vector<glm::vec2> uv0, uv1;
    std::vector<glm::vec4> colors;                   ///< linear, 0..1
    std::vector<float> stiffness, damping, friction; ///< _STIFFNESS, _DAMPING, _FRICTION (N/m, N·s/m, 1)
    std::vector<float> heights;                      ///< _HEIGHT (m, model), of either sign
    std::vector<uint32_t> indices;                   ///< 3 per triangle, counter-clockwise seen from outside
    std::vector<uint32_t> lineIndices;               ///< 2 per segment; strips and loops become segments
    std::vector<uint32_t> pointIndices;              ///< 1 per point
    int material = 0;                                ///< index into Scene::materials, always valid
    bool normalsFromFile = false, tangentsFromFile = false;
    /// Null unless an animation of the file drives the skin or the morph targets; the arrays above are then
    /// the static pose.
    std::shared_ptr<const MeshDeformation> deformation{};
    std::vector<uint32_t> sources{}; ///< by vertex: its vertex in `deformation`; empty without

    [[nodiscard]] size_t triangleCount() const { return indices.size() / 3; }
    [[nodiscard]] size_t lineCount() const { return lineIndices.size() / 2; }
    [[nodiscard]] size_t pointCount() const { return pointIndices.size(); }
};

/// Node transforms are stored as TRS in double so that animation can replace a part of them.
struct Node {
    std::string name;
    int parent = -1; ///< parents come before children in Scene::nodes
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    bool hasMatrix = false; ///< then `matrix` is used unchanged (it may shear)
    glm::dmat4 matrix{1.0};
};

/// A mesh placed in the scene: what the renderer draws and the hand touches as one object.
struct Instance {
    int node = -1;
    int mesh = -1;
    glm::dmat4 sceneFromMesh{1.0}; ///< static pose; may mirror, shear or scale unevenly
    glm::dmat4 nodeFromMesh{
        1.0}; ///< one copy's pose in its node (EXT_mesh_gpu_instancing), else the identity
    /// False for a skinned mesh: its vertices are in the pose of the joints, and its node does not move it.
    bool followsNode = true;
};

enum class Interpolation : uint8_t { Step, Linear, CubicSpline };
enum class AnimatedPath : uint8_t { Translation, Rotation, Scale, Weights };

struct AnimationChannel {
    int node = -1;
    AnimatedPath path = AnimatedPath::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;      ///< s, strictly increasing
    std::vector<glm::vec4> values; ///< xyz(w); 3 per key for CubicSpline (in-tangent, value, out-tangent)
    size_t targets = 0;            ///< of Weights: morph targets of the node's mesh
    std::vector<float> weights{};  ///< of Weights, instead of `values`: `targets` per value
};

struct Animation {
    std::string name;
    double duration = 0.0; ///< s
    std::vector<AnimationChannel> channels;
};

/// A camera of the file, where a node of the shown scene places it in the static pose. Scene frame, metres.
struct SceneCamera {
    std::string name, nodeName; ///< each may be empty
    int index = 0;              ///< in the file's `cameras`
    glm::dvec3 eye{0.0};
    glm::dmat3 axes{1.0}; ///< columns right, up, backwards; a rotation
    bool orthographic = false;
    double fovY = 0.0;       ///< rad, full vertical angle, 0..pi; perspective
    double halfHeight = 0.0; ///< m, > 0; orthographic
    double aspect = 0.0;     ///< width / height of its frame; 0: that of the picture
    double nearPlane = 0.0;  ///< m; > 0 for perspective, >= 0 for orthographic
    double farPlane = std::numeric_limits<double>::infinity(); ///< m, > nearPlane
};

/// A message for the user about a scene that loads nevertheless.
struct Warning {
    std::string place; ///< "materials[2].normalTexture"
    std::string message;
};

/// One of the file's textures, without a material's additions.
struct SceneTexture {
    std::string name;
    TextureRef reference;
};

class Volume;   // engine/volume/volume.h
struct Physics; // engine/scene/physics.h

struct Scene {
    std::string path; ///< as given by the user
    FileStamp file;   ///< of the file itself, not of those that it refers to
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Instance> instances;
    std::vector<Material> materials; ///< never empty: the glTF default material is appended when needed
    std::vector<SceneTexture> textures;
    std::vector<Image> images;
    std::vector<Animation> animations;
    int animation = -1; ///< index of the one that was chosen; -1: the first that moves something
    std::vector<SceneCamera> cameras; ///< in the order of Scene::nodes
    std::vector<Warning> warnings;
    std::vector<std::string> extensionsUsed;
    Bounds bounds; ///< scene frame, static pose, over the instances' vertices; of a volume its whole box
    /// Null, or the volume that the file holds: then the only instance is drawn as the mesh of the surface
    /// where the values are `iso`, and felt as the field of distances from it.
    std::shared_ptr<const Volume> volume;
    double iso = 0.0;
    std::shared_ptr<const Physics> physics; ///< null: no body moves

    [[nodiscard]] uint64_t triangleCount() const; ///< over the instances
    [[nodiscard]] uint64_t lineCount() const;     ///< segments, over the instances
    [[nodiscard]] uint64_t pointCount() const;    ///< over the instances
    [[nodiscard]] bool touchable() const { return triangleCount() > 0; }
};

using ScenePtr = std::shared_ptr<const Scene>;

/// The sets of texture coordinates that exist.
using CoordinateSets = std::array<bool, 2>;

/// The use of a material in its scene.
struct MaterialPlacement {
    bool drawn = false;    ///< some instance has it
    bool placed = false;   ///< some instance with triangles has it
    CoordinateSets sets{}; ///< over the meshes with the material
};
/// One for each material.
[[nodiscard]] std::vector<MaterialPlacement> materialPlacements(const Scene& scene);

/// Longest side of a model fitted to the device's workspace, m. A Phantom Premium 1.5 spans 381 x 267 x 191
/// mm; 0.15 m leaves room to approach the model from every side. A larger value makes device motion coarser
/// relative to the model.
inline constexpr double kFittedExtent = 0.15;

enum class Fit : uint8_t { None, Workspace };

/// The similarity that places a scene in the device's workspace: `None` is the identity, `Workspace` centres
/// the bounds at the origin and scales the longest side to kFittedExtent; less where the model is smaller
/// than the rounding of its place in the scene.
[[nodiscard]] Similarity workspaceFromScene(const Scene& scene, Fit fit);

} // namespace touchstone
