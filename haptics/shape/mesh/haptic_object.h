#pragma once
// One touchable object: a welded triangle soup in its own frame, and its search trees.

#include "engine/math/similarity.h"
#include "engine/scene/scene.h"
#include "haptics/shape/mesh/mesh_instant.h"
#include "haptics/shape/mesh/ray_tree.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/shape/mesh/triangle_tree.h"
#include "haptics/shape/mesh/vertex_gradients.h"
#include "haptics/shape/shape.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// Vertices of an object nearer than this fraction of its diagonal are one vertex; HapticObject counts them.
/// A narrower crack is closed at any proxy radius, also at zero.
inline constexpr double kWeldTolerance = 1e-6;

/// The properties of the material that determine what an object stores: the vertex attributes that its
/// effects read (others are dropped), and its sides.
struct ObjectUse {
    bool uv[2] = {};          ///< coordinates of a map that is felt
    bool uvGradients[2] = {}; ///< and their gradients over the surface: of a height map
    bool tangents = false;    ///< of a normal map
    bool normals = false;     ///< of force shading, where the surface is smooth
    bool oneSided = false;    ///< `sides` is front
    bool implicit = false;    ///< felt as a distance field: nothing of the above
    float voxelSize = 0.0f;   ///< of the field, model metres; 0: chosen from fieldError or the object's size
    float fieldError = 0.0f;  ///< how far its surface may be from the triangles, model metres; 0: not stated
    FieldTexture fieldTexture{};
    bool operator==(const ObjectUse&) const = default;
};

/// Memory that an object holds for effects, bytes.
struct AttributeBytes {
    uint64_t normals = 0, tangents = 0, uv[2] = {}, bump = 0, stiffness = 0, damping = 0, friction = 0;
    [[nodiscard]] uint64_t all() const {
        return normals + tangents + uv[0] + uv[1] + bump + stiffness + damping + friction;
    }
};

/// Immutable. Object frame: centred on the object, longest side 1, so that float vertices are accurate to
/// 6e-8 of the object wherever it stands and however large it is. Triangle t is triangle t of the source
/// mesh; its corners are reversed where the node mirrors, so that the winding always faces outwards.
struct HapticObject {
    std::string name;
    /// The geometry of an object that is not a mesh: it has no vertices, triangles or data on them.
    std::shared_ptr<const Shape> shape;
    int instance = -1;               ///< Scene::instances
    int material = 0;                ///< Scene::materials
    std::vector<glm::vec3> vertices; ///< welded, object frame; one spare entry for Embree's 16-byte reads
    std::vector<uint32_t> indices;   ///< 3 per triangle into `vertices`
    std::vector<uint32_t>
        sourceIndices;               ///< 3 per triangle into the mesh's vertex attributes, same corner order
    std::vector<glm::vec3> normals;  ///< per source vertex, object frame, unit; empty unless anySmooth
    std::vector<glm::vec4> tangents; ///< per source vertex, object frame; may be empty
    std::vector<glm::vec2> uv[2];    ///< per source vertex; may be empty
    std::vector<float> stiffness, damping, friction; ///< per source vertex; may be empty
    std::vector<float> heights;                      ///< per source vertex, model metres; may be empty
    float minHeight = 0.0f, greatestHeight = 0.0f;
    std::vector<GradientPair>
        uvGradients[2]; ///< per source vertex, per object unit; only of a height map's set
    std::vector<GradientPair> heightGradients; ///< of `heights`, model metres per object unit; second unused
    std::vector<uint8_t> smooth;    ///< per triangle: 1 where vertex and face normals differ, for shading
    Similarity workspaceFromObject; ///< rest pose
    glm::dmat4 objectFromMesh{1.0}; ///< the transform baked into the vertices
    double diagonal = 0.0;          ///< of the bounds, object units
    double boundingRadius = 0.0;    ///< about the object's origin, object units
    uint32_t weldedVertices = 0;    ///< vertices merged into another one
    uint32_t droppedTriangles = 0;  ///< triangles with two equal corners after welding
    bool closed = false;            ///< every edge has an even number of triangles
    bool anySmooth = false;
    bool oneSided = false; ///< the material's `sides` is front: felt only from outside
    /// Part of a mesh (buildCutObject): `sourceIndices` count the part's vertices, not the scene's, so that
    /// nothing may take them for those of a mesh that deforms.
    bool cut = false;
    bool shell = false; ///< `shape` is the field of an open mesh, a shell about it: a cut leaves it hollow
    RayTree rays;       ///< Embree's, for rays; built on demand
    TriangleTree tree;  ///< for proximity queries
    /// Null but in a world's own copy of an object that deforms (world/deforming_objects.h): then the
    /// vertices of this tick, instead of `vertices`, `normals` and `tree`, which are those of the static
    /// pose.
    const MeshInstant* instant = nullptr;

    [[nodiscard]] size_t triangleCount() const { return indices.size() / 3; }
    /// Nothing is left of it (scene/scene_parts.h): no query meets it.
    [[nodiscard]] bool empty() const { return shape == nullptr && indices.empty(); }
    [[nodiscard]] uint64_t memoryBytes() const;          ///< without Embree's part
    [[nodiscard]] AttributeBytes attributeBytes() const; ///< part of memoryBytes
};

/// Vertex `index` of the object, object frame.
[[nodiscard]] inline glm::dvec3 vertexOf(const HapticObject& object, uint32_t index) noexcept {
    if (object.instant != nullptr) [[unlikely]]
        return object.instant->now.at(index);
    return glm::dvec3(object.vertices[index]);
}

/// The normal of source vertex `index`, where the object has any; object frame.
[[nodiscard]] inline glm::dvec3 normalOf(const HapticObject& object, uint32_t index) noexcept {
    if (object.instant != nullptr && object.instant->normals.from != nullptr) [[unlikely]]
        return object.instant->normals.at(index);
    return glm::dvec3(object.normals[index]);
}

/// The tree whose boxes hold the object's triangles.
[[nodiscard]] inline const TriangleTree& treeOf(const HapticObject& object) noexcept {
    return object.instant != nullptr ? *object.instant->tree : object.tree;
}

/// triangleOf of an object that deforms. Out of line: a scene at rest keeps its code, and its last bits.
[[nodiscard]] Triangle deformedTriangle(const HapticObject& object, uint32_t index) noexcept;

/// Triangle `index` of the object, object frame.
[[nodiscard]] inline Triangle triangleOf(const HapticObject& object, uint32_t index) noexcept {
    if (object.instant != nullptr) [[unlikely]]
        return deformedTriangle(object, index);
    const uint32_t* corner = &object.indices[3 * static_cast<size_t>(index)];
    return {glm::dvec3(object.vertices[corner[0]]), glm::dvec3(object.vertices[corner[1]]),
            glm::dvec3(object.vertices[corner[2]])};
}

/// The same of a triangle that the object's tree has found at `place`.
[[nodiscard]] inline Triangle triangleAt(const HapticObject& object, uint32_t place,
                                         uint32_t index) noexcept {
    if (!TriangleTree::isCopied(place)) [[unlikely]]
        return triangleOf(object, index);
    const std::array<glm::vec3, 3> corner = object.tree.corners(place);
    return {glm::dvec3(corner[0]), glm::dvec3(corner[1]), glm::dvec3(corner[2])};
}

/// Builds the object of one instance. `workspaceFromScene` places it. Throws Error when Embree fails, and
/// Cancelled.
[[nodiscard]] std::unique_ptr<const HapticObject> buildHapticObject(const Scene& scene, int instance,
                                                                    const Similarity& workspaceFromScene,
                                                                    const ObjectUse& use,
                                                                    const Progress& progress = {});

/// The same of an instance whose mesh is a part of `whole`: in the frame of the object of `whole`, to the
/// last bit, so that a place in the one is the same place in the other.
[[nodiscard]] std::unique_ptr<const HapticObject>
buildCutObject(const Scene& scene, int instance, const Mesh& whole, const Similarity& workspaceFromScene,
               const ObjectUse& use, const Progress& progress = {});

/// Centre and radius of a sphere around the object at a pose, workspace.
[[nodiscard]] inline glm::dvec4 boundingSphere(const HapticObject& object,
                                               const Similarity& workspaceFromObject) {
    return {workspaceFromObject.translation, workspaceFromObject.scale * object.boundingRadius};
}

/// True where `point` (object frame) lies inside the closed object: parity of crossings, majority of three
/// directions. Bounded; safe on the servo thread. Always false for open objects.
[[nodiscard]] bool insideObject(const HapticObject& object, const glm::dvec3& point) noexcept;

} // namespace touchstone
