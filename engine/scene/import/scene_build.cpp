#include "engine/scene/import/scene_build.h"

#include "engine/scene/animation.h"
#include "engine/scene/import/gltf_haptics.h"
#include "engine/scene/import/gltf_mpeg.h"
#include "engine/scene/import/mesh_build.h"
#include "engine/scene/mesh_vertices.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace touchstone {
namespace {

/// Beyond this many vertices over all instances the bounds come from the meshes' boxes: never too small.
constexpr uint64_t kExactBoundsVertices = 100'000'000;

uint64_t bytesOf(const Mesh& mesh) {
    const size_t indices = mesh.indices.size() + mesh.lineIndices.size() + mesh.pointIndices.size();
    return sizeof(Mesh) + sizeof(Material) + mesh.positions.size() * bytesPerVertex(mesh) +
           indices * sizeof(mesh.indices[0]);
}

/// The scene's meshes of one glTF mesh, by the physics material that its nodes give it.
class MeshVariants {
  public:
    MeshVariants(ImportContext& context, const GltfDocument& document, MaterialTable& materials, Scene& scene)
        : context_(context), document_(document), materials_(materials), scene_(scene) {}

    /// Indices into scene.meshes, one per primitive that has something to draw.
    const std::vector<int>& get(size_t gltfMesh, int physics) {
        const auto [found, isNew] = made_.try_emplace({gltfMesh, physics});
        if (!isNew)
            return found->second;
        const auto other = made_.lower_bound({gltfMesh, -1});
        const bool copy = other != made_.end() && other->first.first == gltfMesh && other != found &&
                          !other->second.empty();
        // The first variant is built from the file, later ones are copies that differ in their material.
        found->second = copy ? copyAll(gltfMesh, physics, other->second) : buildAll(gltfMesh, physics);
        return found->second;
    }

  private:
    int materialFor(size_t gltfMesh, size_t primitive, int physics) {
        const int mpeg = mpegMaterialOf(context_, document_, gltfMesh).value_or(-1);
        return materials_.indexOf(
            {document_.model.meshes[gltfMesh].primitives[primitive].material, mpeg, physics});
    }

    std::vector<int> buildAll(size_t gltfMesh, int physics) {
        std::vector<int> indices;
        for (size_t p = 0; p < document_.model.meshes[gltfMesh].primitives.size(); ++p) {
            const int material = materialFor(gltfMesh, p, physics);
            auto mesh = buildMesh(context_, document_, gltfMesh, p, materials_.material(material));
            if (!mesh)
                continue;
            mesh->material = material;
            indices.push_back(static_cast<int>(scene_.meshes.size()));
            scene_.meshes.push_back(std::move(*mesh));
            primitiveOf_.push_back(p);
        }
        return indices;
    }

    std::vector<int> copyAll(size_t gltfMesh, int physics, const std::vector<int>& from) {
        std::vector<int> indices;
        for (const int source : from) {
            const size_t primitive = primitiveOf_[static_cast<size_t>(source)];
            context_.spendGeometry(bytesOf(scene_.meshes[static_cast<size_t>(source)]),
                                   element("meshes", gltfMesh));
            Mesh mesh = scene_.meshes[static_cast<size_t>(source)];
            mesh.material = materialFor(gltfMesh, primitive, physics);
            indices.push_back(static_cast<int>(scene_.meshes.size()));
            scene_.meshes.push_back(std::move(mesh));
            primitiveOf_.push_back(primitive);
        }
        return indices;
    }

    ImportContext& context_;
    const GltfDocument& document_;
    MaterialTable& materials_;
    Scene& scene_;
    std::map<std::pair<size_t, int>, std::vector<int>> made_;
    std::vector<size_t> primitiveOf_; // by scene mesh
};

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

} // namespace

void buildMeshesAndInstances(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                             MaterialTable& materials, Scene& scene) {
    const std::vector<int> physics = physicsMaterialOfNodes(context, document);
    std::vector<glm::dmat4> sceneFromNode(scene.nodes.size());
    MeshVariants variants(context, document, materials, scene);
    bool skinned = false;
    uint64_t placedTriangles = 0;
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        const glm::dmat4 local = parentFromNode(node);
        sceneFromNode[n] = node.parent >= 0 ? sceneFromNode[static_cast<size_t>(node.parent)] * local : local;
        const size_t gltfNode = static_cast<size_t>(forest.gltfOfNode[n]);
        const int gltfMesh = document.model.nodes[gltfNode].mesh;
        if (gltfMesh < 0 || !forest.shown[n])
            continue;
        const std::string place = element("nodes", gltfNode);
        context.step(0.1 + 0.4 * static_cast<double>(n) / static_cast<double>(scene.nodes.size()),
                     "building meshes");
        if (!isFinite(sceneFromNode[n]))
            context.fail(place, "its place is beyond what numbers can hold",
                         "check the scales of the node and its parents");
        const std::vector<int>& meshes = variants.get(static_cast<size_t>(gltfMesh), physics[gltfNode]);
        skinned = skinned || document.json["nodes"][gltfNode].contains("skin");
        if (isFlattened(sceneFromNode[n])) {
            context.warn(place, "is scaled to nothing in some direction; its mesh is left out");
            continue;
        }
        if (scene.instances.size() + meshes.size() > kMaxInstances)
            context.fail(place, "places more than " + std::to_string(kMaxInstances) + " meshes",
                         "split the model into several files");
        for (const int mesh : meshes) {
            const Mesh& placed = scene.meshes[static_cast<size_t>(mesh)];
            placedTriangles += placed.triangleCount() + placed.lineCount() + placed.pointCount();
            scene.instances.push_back({static_cast<int>(n), mesh, sceneFromNode[n]});
        }
        if (placedTriangles > std::max(kFreePlacedTriangles, context.fileBytes()))
            context.fail(place,
                         "the scene places more than " + std::to_string(placedTriangles) +
                             " triangles, lines and points, far beyond the file's own data",
                         "place its meshes fewer times, or simplify them");
    }
    if (skinned)
        context.warn("skins", "skinned meshes stay in their rest pose");
    // Meshes that nobody placed are checked like the others: a broken file should not depend on who looks.
    for (size_t m = 0; m < document.model.meshes.size(); ++m)
        (void)variants.get(m, -1);
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

    Bounds bounds;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const auto include = [&](const glm::dvec3& p) {
            bounds.include(glm::dvec3(instance.sceneFromMesh * glm::dvec4(p, 1.0)));
        };
        if (exact) {
            // Only vertices that are drawn: exporters leave strays behind.
            for (const auto* indices : {&mesh.indices, &mesh.lineIndices, &mesh.pointIndices})
                for (const uint32_t index : *indices)
                    include(glm::dvec3(mesh.positions[index]));
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
