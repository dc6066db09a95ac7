#include "engine/import/geometry/scene_build.h"

#include "engine/import/geometry/instancing.h"
#include "engine/import/geometry/mesh_variants.h"
#include "engine/import/geometry/morph.h"
#include "engine/import/materials/gltf_haptics.h"
#include "engine/scene/animation.h"

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

/// Beyond this many vertices over all instances the bounds come from the meshes' boxes: never too small.
constexpr uint64_t kExactBoundsVertices = 100'000'000;

bool isFinite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r]))
                return false;
    return true;
}

/// A scale of zero in some direction: no volume, no inverse, no normals.
bool isFlattened(const glm::dmat4& m) {
    const double size =
        glm::length(glm::dvec3(m[0])) * glm::length(glm::dvec3(m[1])) * glm::length(glm::dvec3(m[2]));
    return !(std::abs(glm::determinant(glm::dmat3(m))) > 1e-12 * size);
}

/// Places meshes on nodes: fills scene.instances, within the limits of an import.
class Placement {
  public:
    Placement(ImportContext& context, const GltfDocument& document, Scene& scene)
        : context_(context), document_(document), scene_(scene) {}

    /// Places the meshes of `node`, once for each of its copies. Flattened instances are left out with a
    /// warning.
    void place(size_t node, size_t gltfNode, const glm::dmat4& sceneFromNode,
               const std::vector<MeshVariant>& meshes) {
        place_ = element("nodes", gltfNode);
        const auto copies = readCopies(context_, document_, gltfNode, copies_);
        if (!copies) {
            (void)add(node, sceneFromNode, glm::dmat4(1.0), false, meshes);
            return;
        }
        copies_ += copies->size();
        size_t flattened = 0;
        for (const glm::dmat4& nodeFromMesh : *copies)
            flattened += add(node, sceneFromNode, nodeFromMesh, true, meshes) ? 0 : 1;
        if (flattened > 0)
            context_.warn(place_, std::to_string(flattened) +
                                      " of its copies are scaled to nothing in some direction; left out");
    }

  private:
    /// False if the copy is flattened.
    bool add(size_t node, const glm::dmat4& sceneFromNode, const glm::dmat4& nodeFromMesh, bool isCopy,
             const std::vector<MeshVariant>& meshes) {
        attempted_ += meshes.size(); // instances left out as flat also take time
        if (attempted_ > kMaxInstances)
            context_.fail(place_, "places more than " + std::to_string(kMaxInstances) + " meshes",
                          "split the model into several files");
        const glm::dmat4 rigid = isCopy ? sceneFromNode * nodeFromMesh : sceneFromNode;
        bool stands = true;
        for (const MeshVariant& variant : meshes) {
            Instance instance;
            instance.node = static_cast<int>(node);
            instance.mesh = variant.mesh;
            instance.nodeFromMesh = nodeFromMesh;
            instance.followsNode = !variant.origin;
            instance.sceneFromMesh =
                variant.origin ? sceneFromSkin(*variant.origin, sceneFromNode, nodeFromMesh, isCopy) : rigid;
            if (!isFinite(instance.sceneFromMesh))
                context_.fail(place_, "its place is beyond what numbers can hold",
                              "check the scales of the node and its parents");
            if (isFlattened(instance.sceneFromMesh)) {
                stands = false;
                if (!isCopy)
                    context_.warn(place_, "is scaled to nothing in some direction; its mesh is left out");
                continue;
            }
            const Mesh& mesh = scene_.meshes[static_cast<size_t>(variant.mesh)];
            spendPrimitives(mesh.triangleCount() + mesh.lineCount() + mesh.pointCount());
            scene_.instances.push_back(instance);
        }
        return stands;
    }

    /// A skin is placed by its joints. A copy of it is displaced from there as a rigid mesh is displaced from
    /// the node's own place: by sceneFromNode * nodeFromMesh * nodeFromScene.
    glm::dmat4 sceneFromSkin(const glm::dvec3& origin, const glm::dmat4& sceneFromNode,
                             const glm::dmat4& nodeFromMesh, bool isCopy) {
        glm::dmat4 sceneFromMesh(1.0);
        sceneFromMesh[3] = glm::dvec4(origin, 1.0);
        if (!isCopy)
            return sceneFromMesh;
        if (!isFinite(sceneFromNode) || isFlattened(sceneFromNode)) {
            context_.warn(place_,
                          "places copies of a skinned mesh in a frame that is flat: they are placed in the "
                          "scene's frame");
            return nodeFromMesh * sceneFromMesh;
        }
        return sceneFromNode * nodeFromMesh * glm::inverse(sceneFromNode) * sceneFromMesh;
    }

    void spendPrimitives(uint64_t count) {
        placed_ += count;
        if (placed_ > std::max(kFreePlacedTriangles, context_.fileBytes()))
            context_.fail(place_,
                          "the scene places more than " + std::to_string(placed_) +
                              " triangles, lines and points, far beyond the file's own data",
                          "place its meshes fewer times, or simplify them");
    }

    ImportContext& context_;
    const GltfDocument& document_;
    Scene& scene_;
    std::string place_;
    uint64_t copies_ = 0, placed_ = 0, attempted_ = 0; // attempted: placements, including flat ones
};

} // namespace

void buildMeshesAndInstances(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                             MaterialTable& materials, Scene& scene) {
    const std::vector<int> physics = physicsMaterialOfNodes(context, document);
    const std::vector<glm::dmat4> sceneFromNode = sceneFromNodes(scene.nodes);
    std::vector<bool> driven(scene.nodes.size(), false), weighted(scene.nodes.size(), false);
    for (const Animation& animation : scene.animations) {
        const std::vector<bool> moved = movedNodes(scene, animation);
        for (size_t n = 0; n < moved.size(); ++n)
            driven[n] = driven[n] || moved[n];
        for (const AnimationChannel& channel : animation.channels)
            if (channel.path == AnimatedPath::Weights)
                weighted[static_cast<size_t>(channel.node)] = true;
    }
    SkinPoses skins(context, document, forest, scene.nodes, sceneFromNode, driven);
    MeshVariants variants(context, document, materials, skins, scene);
    Placement placement(context, document, scene);
    const std::vector<size_t> targets = morphTargetCounts(context, document);
    const Progress nodes = context.progress().part(0.35, 0.79);
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const size_t gltfNode = static_cast<size_t>(forest.gltfOfNode[n]);
        const tinygltf::Node& node = document.model.nodes[gltfNode];
        if (node.mesh < 0 || !forest.shown[n])
            continue;
        context.enter(nodes.part(share(n, scene.nodes.size()), share(n + 1, scene.nodes.size())));
        context.part().step(0.0, "building meshes");
        const auto gltfMesh = static_cast<size_t>(node.mesh);
        const ShownMesh shown{
            gltfMesh, node.skin,
            morphWeights(context, document, gltfMesh, targets[gltfMesh], static_cast<int>(gltfNode)),
            weighted[n] ? static_cast<int>(n) : -1, physics[gltfNode]};
        placement.place(n, gltfNode, sceneFromNode[n], variants.get(shown));
    }
    // Meshes that no node places are checked as well: whether a broken file is refused does not depend on the
    // scene shown.
    const Progress others = context.progress().part(0.79, 0.8);
    for (size_t m = 0; m < document.model.meshes.size(); ++m) {
        context.enter(
            others.part(share(m, document.model.meshes.size()), share(m + 1, document.model.meshes.size())));
        if (!variants.has(m))
            (void)variants.get({m, -1, morphWeights(context, document, m, targets[m], -1), -1, -1});
    }
}

Bounds sceneBounds(const ImportContext& context, const Scene& scene) {
    uint64_t vertices = 0;
    for (const Instance& instance : scene.instances)
        vertices += scene.meshes[static_cast<size_t>(instance.mesh)].positions.size();
    const bool exact = vertices <= kExactBoundsVertices;
    std::vector<Bounds> boxes(exact ? 0 : scene.meshes.size());
    for (size_t m = 0; m < boxes.size(); ++m)
        for (const glm::vec3& p : scene.meshes[m].positions)
            boxes[m].include(glm::dvec3(p));

    const auto indexCount = [](const Mesh& mesh) {
        return mesh.indices.size() + mesh.lineIndices.size() + mesh.pointIndices.size();
    };
    size_t indicesOfAll = 0, done = 0;
    for (const Instance& instance : scene.instances)
        indicesOfAll += indexCount(scene.meshes[static_cast<size_t>(instance.mesh)]);
    Bounds bounds;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const auto include = [&](const glm::dvec3& p) {
            bounds.include(glm::dvec3(instance.sceneFromMesh * glm::dvec4(p, 1.0)));
        };
        if (exact) {
            // Only drawn vertices: exporters leave stray ones behind.
            std::vector<bool> included(mesh.positions.size(), false);
            for (const auto* indices : {&mesh.indices, &mesh.lineIndices, &mesh.pointIndices})
                for (size_t i = 0; i < indices->size(); ++i) {
                    if (i % kProgressWork == 0)
                        context.part().step(share(done + i, indicesOfAll), "measuring the scene");
                    if (const uint32_t index = (*indices)[i]; !included[index]) {
                        included[index] = true;
                        include(glm::dvec3(mesh.positions[index]));
                    }
                }
            done += indexCount(mesh);
            continue;
        }
        const Bounds& box = boxes[static_cast<size_t>(instance.mesh)];
        for (int corner = 0; corner < 8 && !box.empty(); ++corner)
            include({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                     corner & 4 ? box.high.z : box.low.z});
    }
    if (!bounds.empty() && !std::isfinite(glm::dot(bounds.extent(), bounds.extent())))
        context.fail("nodes", "the scene is larger than numbers can hold", "check the scales of the nodes");
    return bounds;
}

} // namespace touchstone
