#include "haptics/shape/mesh/haptic_object.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "engine/core/huge_pages.h"
#include "engine/core/parallel.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/scene/mesh_vertices.h"
#include "haptics/shape/mesh/weld.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <utility>

namespace touchstone {

namespace {

constexpr const char* kPlacing = "placing vertices";
constexpr const char* kIndices = "welding indices";
constexpr const char* kAttributes = "taking over attributes";
constexpr const char* kSmoothness = "looking for smooth places";
constexpr const char* kGradients = "following the texture over the surface";
/// A triangle is smooth where a vertex normal deviates from the face normal by more than this. Below it
/// shading would turn the force by less than 0.11 degrees: under every published threshold of force
/// direction.
constexpr double kSmoothCosine = 0.999998;

void markSmoothTriangles(HapticObject& object, const Progress& progress) {
    std::atomic<bool> any{false};
    inParallel(object.triangleCount(), progress, kSmoothness, [&](size_t begin, size_t end) {
        bool here = false;
        for (size_t t = begin; t < end; ++t) {
            const glm::dvec3 face = triangleOf(object, static_cast<uint32_t>(t)).normal;
            if (face == glm::dvec3(0.0))
                continue;
            for (size_t k = 0; k < 3; ++k) {
                const glm::dvec3 normal(object.normals[object.sourceIndices[3 * t + k]]);
                if (glm::dot(normal, face) < kSmoothCosine)
                    object.smooth[t] = 1;
            }
            here |= object.smooth[t] != 0;
        }
        if (here)
            any.store(true, std::memory_order_relaxed);
    });
    object.anySmooth = any.load();
}

/// Transforms the attributes of the source vertices into the object frame. Normals transform with the inverse
/// transpose. A mirroring node flips the handedness of the tangent frame.
void copyAttributes(const Mesh& mesh, const glm::dmat3& linear, bool mirrored, const ObjectUse& use,
                    HapticObject& object, const Progress& progress) {
    const bool invertible = std::abs(glm::determinant(linear)) > 0.0;
    const glm::dmat3 normalFrom = invertible ? glm::transpose(glm::inverse(linear)) : glm::dmat3(1.0);
    object.normals.resize(mesh.positions.size(), glm::vec3(0, 1, 0));
    inParallel(mesh.normals.size(), progress.part(0.0, 0.5), kAttributes, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; ++v) {
            const glm::dvec3 normal = normalFrom * glm::dvec3(mesh.normals[v]);
            const double length = glm::length(normal);
            if (length > 0.0)
                object.normals[v] = glm::vec3(normal / length);
        }
    });
    object.tangents.resize(use.tangents ? mesh.tangents.size() : 0);
    inParallel(object.tangents.size(), progress.part(0.5, 1.0), kAttributes, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; ++v) {
            const glm::vec4& t = mesh.tangents[v];
            const glm::dvec3 tangent = linear * glm::dvec3(t.x, t.y, t.z);
            const double length = glm::length(tangent);
            const glm::vec3 unit(length > 0.0 ? tangent / length : glm::dvec3(0.0));
            object.tangents[v] = glm::vec4(unit, mirrored ? -t.w : t.w);
        }
    });
    if (use.uv[0])
        object.uv[0] = mesh.uv0;
    if (use.uv[1])
        object.uv[1] = mesh.uv1;
    object.stiffness = mesh.stiffness;
    object.damping = mesh.damping;
    object.friction = mesh.friction;
    object.heights = mesh.heights;
    if (!mesh.heights.empty()) {
        const auto [least, greatest] = std::minmax_element(mesh.heights.begin(), mesh.heights.end());
        object.minHeight = *least;
        object.greatestHeight = *greatest;
    }
}

/// Adds the gradients that texture needs on a smooth surface; nothing where no height is felt.
void addGradients(const ObjectUse& use, HapticObject& object, const Progress& progress) {
    constexpr double kTimePerTriangle = 1e-6; // s
    progress.stopIfCancelled();
    if (object.heights.empty() && !use.uvGradients[0] && !use.uvGradients[1])
        return;
    const EstimatedProgress estimate(progress, kGradients,
                                     kTimePerTriangle * static_cast<double>(object.triangleCount()));
    const GradientMesh mesh{object.vertices, object.indices, object.sourceIndices, object.normals};
    for (size_t set = 0; set < 2; ++set)
        if (use.uvGradients[set] && !object.uv[set].empty())
            object.uvGradients[set] = smoothGradients(mesh, object.uv[set], Charted::Yes);
    if (!object.heights.empty()) {
        std::vector<glm::vec2> values(object.heights.size());
        for (size_t v = 0; v < values.size(); ++v)
            values[v].x = object.heights[v];
        object.heightGradients = smoothGradients(mesh, values, Charted::No);
    }
}

/// What moves a vertex of a deforming mesh, apart from its place: equal for vertices that move together.
uint64_t motionOf(const MeshDeformation& deformation, size_t vertex) {
    Hash64 hash;
    for (size_t k = vertex * deformation.perVertex; k < (vertex + 1) * deformation.perVertex; ++k) {
        hash.add(deformation.vertexWeights[k] > 0.0f ? deformation.vertexJoints[k] : 0u);
        hash.add(deformation.vertexWeights[k]);
    }
    for (const MorphTarget& target : deformation.targets)
        if (!target.positions.empty())
            for (int c = 0; c < 3; ++c)
                hash.add(target.positions[vertex][c]);
    return hash.value();
}

/// Parts the clusters whose vertices an animation moves apart: lips that are closed in the static pose.
void partClusters(const Mesh& mesh, const std::vector<glm::vec3>& local, WeldResult& weld) {
    std::map<std::pair<uint32_t, uint64_t>, uint32_t> clusters;
    std::vector<glm::vec3> vertices;
    for (uint32_t v = 0; v < weld.remap.size(); ++v) {
        const auto [found, fresh] =
            clusters.emplace(std::pair(weld.remap[v], motionOf(*mesh.deformation, mesh.sources[v])),
                             static_cast<uint32_t>(vertices.size()));
        if (fresh)
            vertices.push_back(local[v]);
        weld.remap[v] = found->second;
    }
    weld.vertices = std::move(vertices);
}

/// Welds `local`, fills the index buffers and counts welded vertices and dropped triangles.
void weldGeometry(const Mesh& mesh, std::vector<glm::vec3> local, HapticObject& object,
                  const Progress& progress) {
    WeldResult weld = weldVertices(local, kWeldTolerance * object.diagonal, progress.part(0.0, 0.5));
    if (mesh.deformation != nullptr)
        partClusters(mesh, local, weld);
    local = {};
    object.vertices = std::move(weld.vertices);
    object.weldedVertices = weld.merged;
    reserveInHugePages(object.indices, object.sourceIndices.size());
    object.indices.resize(object.sourceIndices.size());
    inParallel(object.indices.size(), progress.part(0.5, 0.6), kIndices, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            object.indices[i] = weld.remap[object.sourceIndices[i]];
    });
    weld.remap = {};
    for (size_t t = 0; t < object.triangleCount(); ++t) {
        const uint32_t* i = &object.indices[3 * t];
        if (i[0] == i[1] || i[1] == i[2] || i[2] == i[0])
            ++object.droppedTriangles;
    }
    object.closed = isClosed(object.indices, object.vertices.size(), progress.part(0.6, 1.0));
    std::vector<glm::vec3> vertices;
    reserveInHugePages(vertices, object.vertices.size() + 1);
    vertices.assign(object.vertices.begin(), object.vertices.end());
    vertices.emplace_back(0.0f); // spare, for Embree's 16-byte reads
    object.vertices = std::move(vertices);
}

/// Chooses the object's frame by the vertices of `whole`; returns those of `mesh` in it.
std::vector<glm::vec3> placeVertices(const Mesh& mesh, const Mesh& whole, const glm::dmat4& sceneFromMesh,
                                     const Similarity& workspaceFromScene, HapticObject& object,
                                     const Progress& progress) {
    // Scene positions in double, then one centre and one scale for the float frame. They are computed twice:
    // stored, they would be the largest array of all.
    const auto inScene = [&](const Mesh& from, size_t v) {
        return glm::dvec3(sceneFromMesh * glm::dvec4(glm::dvec3(from.positions[v]), 1.0));
    };
    const size_t framed = whole.positions.size();
    std::vector<Bounds> boxes(framed / kProgressWork + 1);
    inParallel(framed, progress.part(0.0, 0.4), kPlacing, [&](size_t begin, size_t end) {
        Bounds box;
        for (size_t v = begin; v < end; ++v)
            box.include(inScene(whole, v));
        boxes[begin / kProgressWork] = box;
    });
    Bounds bounds;
    for (const Bounds& box : boxes)
        if (!box.empty()) {
            bounds.include(box.low);
            bounds.include(box.high);
        }
    const glm::dvec3 extent = bounds.extent();
    const double longest = std::max({extent.x, extent.y, extent.z});
    Similarity sceneFromObject;
    sceneFromObject.scale = longest > 0.0 ? longest : 1.0;
    sceneFromObject.translation = bounds.centre();
    object.workspaceFromObject = workspaceFromScene * sceneFromObject;
    object.diagonal = glm::length(extent) / sceneFromObject.scale;
    const Similarity objectFromScene = sceneFromObject.inverse();
    glm::dmat4 scaling(objectFromScene.scale);
    scaling[3] = glm::dvec4(objectFromScene.translation, 1.0);
    object.objectFromMesh = scaling * sceneFromMesh;

    const size_t count = mesh.positions.size();
    std::vector<glm::vec3> local(count);
    std::vector<double> radii(count / kProgressWork + 1, 0.0);
    inParallel(count, progress.part(0.4, 1.0), kPlacing, [&](size_t begin, size_t end) {
        double radius = 0.0;
        for (size_t v = begin; v < end; ++v) {
            local[v] = glm::vec3((inScene(mesh, v) - sceneFromObject.translation) / sceneFromObject.scale);
            radius = std::max(radius, glm::length(glm::dvec3(local[v])));
        }
        radii[begin / kProgressWork] = radius;
    });
    object.boundingRadius = *std::max_element(radii.begin(), radii.end());
    return local;
}

template <class T>
uint64_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

} // namespace

Triangle deformedTriangle(const HapticObject& object, uint32_t index) noexcept {
    const uint32_t* corner = &object.indices[3 * static_cast<size_t>(index)];
    return {vertexOf(object, corner[0]), vertexOf(object, corner[1]), vertexOf(object, corner[2])};
}

AttributeBytes HapticObject::attributeBytes() const {
    return {.normals = anySmooth ? bytesOf(normals) + bytesOf(smooth) : 0,
            .tangents = bytesOf(tangents),
            .uv = {bytesOf(uv[0]), bytesOf(uv[1])},
            .bump = bytesOf(heights) + bytesOf(uvGradients[0]) + bytesOf(uvGradients[1]) +
                    bytesOf(heightGradients),
            .stiffness = bytesOf(stiffness),
            .damping = bytesOf(damping),
            .friction = bytesOf(friction)};
}

uint64_t HapticObject::memoryBytes() const {
    return bytesOf(vertices) + bytesOf(indices) + bytesOf(sourceIndices) + (anySmooth ? 0 : bytesOf(smooth)) +
           attributeBytes().all() + tree.memoryBytes() + (shape != nullptr ? shape->memoryBytes() : 0);
}

std::unique_ptr<const HapticObject> buildHapticObject(const Scene& scene, int instanceIndex,
                                                      const Similarity& workspaceFromScene,
                                                      const ObjectUse& use, const Progress& progress) {
    const Instance& instance = scene.instances[static_cast<size_t>(instanceIndex)];
    return buildCutObject(scene, instanceIndex, scene.meshes[static_cast<size_t>(instance.mesh)],
                          workspaceFromScene, use, progress);
}

std::unique_ptr<const HapticObject> buildCutObject(const Scene& scene, int instanceIndex, const Mesh& whole,
                                                   const Similarity& workspaceFromScene, const ObjectUse& use,
                                                   const Progress& progress) {
    const Instance& instance = scene.instances[static_cast<size_t>(instanceIndex)];
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    checkMesh(mesh, scene.path, mesh.name);
    auto object = std::make_unique<HapticObject>();
    object->name = mesh.name;
    object->instance = instanceIndex;
    object->material = mesh.material;
    object->cut = &mesh != &whole;
    object->oneSided = use.oneSided && mesh.deformation == nullptr;

    std::vector<glm::vec3> local = placeVertices(mesh, whole, instance.sceneFromMesh, workspaceFromScene,
                                                 *object, progress.part(0.0, 0.05));
    const glm::dmat3 linear(object->objectFromMesh);
    const bool mirrored = glm::determinant(linear) < 0.0;
    object->sourceIndices = mesh.indices;
    if (mirrored)
        for (size_t t = 0; t + 2 < object->sourceIndices.size(); t += 3)
            std::swap(object->sourceIndices[t + 1], object->sourceIndices[t + 2]);

    weldGeometry(mesh, std::move(local), *object, progress.part(0.05, 0.25));
    copyAttributes(mesh, linear, mirrored, use, *object, progress.part(0.25, 0.29));
    object->smooth.assign(object->triangleCount(), 0);
    if (use.normals)
        markSmoothTriangles(*object, progress.part(0.29, 0.34));
    if (use.normals && mesh.deformation != nullptr && mesh.normalsFromFile) {
        // A facet that is flat in the static pose may bend.
        std::ranges::fill(object->smooth, uint8_t{1});
        object->anySmooth = true;
    }
    addGradients(use, *object, progress.part(0.34, 0.35));
    if (!object->anySmooth)
        object->normals = {};
    object->tree = TriangleTree(object->vertices, object->indices, progress.part(0.35, 0.95));
    if (mesh.deformation == nullptr)
        object->tree.copyCorners(object->vertices, object->indices, progress.part(0.95, 1.0));
    return object;
}

} // namespace touchstone
