#include "haptics/contact/haptic_object.h"

#include "engine/core/error.h"
#include "engine/scene/mesh_vertices.h"
#include "haptics/contact/embree_device.h"
#include "haptics/contact/ray.h"
#include "haptics/contact/weld.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

std::shared_ptr<RTCSceneTy> buildBvh(const HapticObject& object) {
    RTCDevice device = embreeDevice();
    std::shared_ptr<RTCSceneTy> scene(rtcNewScene(device), rtcReleaseScene);
    // Without ROBUST 2.6 % of rays leak through a closed mesh at 1000 m (DESIGN §3).
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, object.vertices.data(),
                               0, sizeof(glm::vec3), object.vertices.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, object.indices.data(), 0,
                               3 * sizeof(uint32_t), object.triangleCount());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene.get());
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
        throw Error(object.name, "", "Embree could not build the search tree",
                    "the model may need more memory than is free");
    return scene;
}

/// A triangle is smooth where a vertex normal leaves the face normal by more than this. Below it shading
/// would turn the force by less than 0.11 degrees: under every published threshold of force direction.
constexpr double kSmoothCosine = 0.999998;

void markSmoothTriangles(HapticObject& object) {
    for (size_t t = 0; t < object.triangleCount(); ++t) {
        const glm::dvec3 face = triangleOf(object, static_cast<uint32_t>(t)).normal;
        if (face == glm::dvec3(0.0))
            continue;
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec3 normal(object.normals[object.sourceIndices[3 * t + k]]);
            if (glm::dot(normal, face) < kSmoothCosine)
                object.smooth[t] = 1;
        }
        object.anySmooth |= object.smooth[t] != 0;
    }
}

/// Attributes of the source vertices, taken to the object frame. Normals go with the inverse transpose. A
/// mirroring node turns the handedness of the tangent frame over.
void copyAttributes(const Mesh& mesh, const glm::dmat3& linear, bool mirrored, const ObjectUse& use,
                    HapticObject& object) {
    const bool invertible = std::abs(glm::determinant(linear)) > 0.0;
    const glm::dmat3 normalFrom = invertible ? glm::transpose(glm::inverse(linear)) : glm::dmat3(1.0);
    object.normals.resize(mesh.positions.size(), glm::vec3(0, 1, 0));
    for (size_t v = 0; v < mesh.normals.size(); ++v) {
        const glm::dvec3 normal = normalFrom * glm::dvec3(mesh.normals[v]);
        const double length = glm::length(normal);
        if (length > 0.0)
            object.normals[v] = glm::vec3(normal / length);
    }
    object.tangents.resize(use.tangents ? mesh.tangents.size() : 0);
    for (size_t v = 0; v < object.tangents.size(); ++v) {
        const glm::vec4& t = mesh.tangents[v];
        const glm::dvec3 tangent = linear * glm::dvec3(t.x, t.y, t.z);
        const double length = glm::length(tangent);
        const glm::vec3 unit(length > 0.0 ? tangent / length : glm::dvec3(0.0));
        object.tangents[v] = glm::vec4(unit, mirrored ? -t.w : t.w);
    }
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
        object.leastHeight = *least;
        object.greatestHeight = *greatest;
    }
}

/// What texture needs to follow a smooth surface rather than its facets; nothing where no height is felt.
void addGradients(const ObjectUse& use, HapticObject& object) {
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

/// Welds `local`, fills the index buffers and counts what the weld did.
void weldGeometry(const std::vector<glm::vec3>& local, HapticObject& object) {
    WeldResult weld = weldVertices(local, kWeldTolerance * object.diagonal);
    object.vertices = std::move(weld.vertices);
    object.vertices.emplace_back(0.0f); // spare, for Embree's 16-byte reads
    object.weldedVertices = weld.merged;
    object.indices.resize(object.sourceIndices.size());
    for (size_t i = 0; i < object.indices.size(); ++i)
        object.indices[i] = weld.remap[object.sourceIndices[i]];
    for (size_t t = 0; t < object.triangleCount(); ++t) {
        const uint32_t* i = &object.indices[3 * t];
        if (i[0] == i[1] || i[1] == i[2] || i[2] == i[0])
            ++object.droppedTriangles;
    }
    object.closed = isClosed(object.indices);
}

template <class T>
uint64_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

} // namespace

AttributeBytes HapticObject::attributeBytes() const {
    return {.normals = anySmooth ? bytesOf(normals) + bytesOf(smooth) : 0,
            .tangents = bytesOf(tangents),
            .uv = {bytesOf(uv[0]), bytesOf(uv[1])},
            .relief = bytesOf(heights) + bytesOf(uvGradients[0]) + bytesOf(uvGradients[1]) +
                      bytesOf(heightGradients),
            .stiffness = bytesOf(stiffness),
            .damping = bytesOf(damping),
            .friction = bytesOf(friction)};
}

uint64_t HapticObject::memoryBytes() const {
    return bytesOf(vertices) + bytesOf(indices) + bytesOf(sourceIndices) + (anySmooth ? 0 : bytesOf(smooth)) +
           attributeBytes().all() + tree.memoryBytes();
}

std::unique_ptr<const HapticObject> buildHapticObject(const Scene& scene, int instanceIndex,
                                                      const Similarity& workspaceFromScene,
                                                      const ObjectUse& use) {
    const Instance& instance = scene.instances[static_cast<size_t>(instanceIndex)];
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    checkMesh(mesh, scene.path, mesh.name);
    auto object = std::make_unique<HapticObject>();
    object->name = mesh.name;
    object->instance = instanceIndex;
    object->material = mesh.material;
    object->oneSided = use.oneSided;

    // Scene positions in double, then one centre and one scale for the float frame.
    std::vector<glm::dvec3> inScene(mesh.positions.size());
    Bounds bounds;
    for (size_t v = 0; v < inScene.size(); ++v) {
        inScene[v] = glm::dvec3(instance.sceneFromMesh * glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0));
        bounds.include(inScene[v]);
    }
    const glm::dvec3 extent = bounds.extent();
    const double longest = std::max({extent.x, extent.y, extent.z});
    Similarity sceneFromObject;
    sceneFromObject.scale = longest > 0.0 ? longest : 1.0;
    sceneFromObject.translation = bounds.centre();
    object->workspaceFromObject = workspaceFromScene * sceneFromObject;
    object->diagonal = glm::length(extent) / sceneFromObject.scale;
    const Similarity objectFromScene = sceneFromObject.inverse();
    glm::dmat4 scaling(objectFromScene.scale);
    scaling[3] = glm::dvec4(objectFromScene.translation, 1.0);
    object->objectFromMesh = scaling * instance.sceneFromMesh;

    std::vector<glm::vec3> local(inScene.size());
    for (size_t v = 0; v < local.size(); ++v) {
        local[v] = glm::vec3((inScene[v] - sceneFromObject.translation) / sceneFromObject.scale);
        object->boundingRadius = std::max(object->boundingRadius, glm::length(glm::dvec3(local[v])));
    }

    const glm::dmat3 linear(object->objectFromMesh);
    const bool mirrored = glm::determinant(linear) < 0.0;
    object->sourceIndices = mesh.indices;
    if (mirrored)
        for (size_t t = 0; t + 2 < object->sourceIndices.size(); t += 3)
            std::swap(object->sourceIndices[t + 1], object->sourceIndices[t + 2]);

    weldGeometry(local, *object);
    copyAttributes(mesh, linear, mirrored, use, *object);
    object->smooth.assign(object->triangleCount(), 0);
    if (use.normals)
        markSmoothTriangles(*object);
    addGradients(use, *object);
    if (!object->anySmooth)
        object->normals = {};
    object->bvh = buildBvh(*object);
    object->tree = TriangleTree(object->vertices, object->indices);
    return object;
}

namespace {

/// How many triangles the ray crosses between `near` and `far`, which are close together: the two faces of a
/// plate without thickness lie in one place, and Embree tells one of them. One where there are too many to
/// count, or where the ray meets an edge that rounding lets it miss here.
int crossingsAt(const HapticObject& object, const glm::dvec3& from, const glm::dvec3& direction, double near,
                double far) noexcept {
    std::array<TriangleTree::Near, 64> found;
    const double middle = 0.5 * (near + far);
    const size_t count = object.tree.collect(glm::vec3(from + middle * direction),
                                             static_cast<float>(far - middle) + TriangleTree::kDoubt, found);
    if (count >= found.size())
        return 1;
    int crossings = 0;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t* corner = &object.indices[3 * size_t{found[i].triangle}];
        const glm::dvec3 a(object.vertices[corner[0]]), ab = glm::dvec3(object.vertices[corner[1]]) - a,
                                                        ac = glm::dvec3(object.vertices[corner[2]]) - a,
                                                        across = glm::cross(direction, ac);
        const double volume = glm::dot(ab, across);
        if (volume == 0.0)
            continue;
        const glm::dvec3 turned = glm::cross(from - a, ab);
        const double u = glm::dot(from - a, across) / volume, v = glm::dot(direction, turned) / volume,
                     at = glm::dot(ac, turned) / volume;
        crossings += u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at >= near && at <= far;
    }
    return std::max(crossings, 1);
}

} // namespace

bool insideObject(const HapticObject& object, const glm::dvec3& point) noexcept {
    if (!object.closed || glm::length(point) > object.boundingRadius)
        return false;
    // Directions without a simple relation to the axes, so that no ray runs along a facet of a box.
    constexpr glm::vec3 kDirections[3] = {
        {0.4823f, 0.7617f, 0.4327f}, {-0.8019f, 0.2673f, 0.5345f}, {0.1690f, -0.5071f, -0.8452f}};
    constexpr int kMaxCrossings = 256;
    constexpr float kFar = 8.0f, kTogether = 1e-6f; // lengths of the object's frame
    const glm::vec3 from(point);
    int votes = 0;
    for (const glm::vec3& direction : kDirections) {
        bool inside = false;
        float start = 0.0f;
        for (int crossing = 0; crossing < kMaxCrossings; ++crossing) {
            const std::optional<RayHit> hit = castRay(object, from, direction, start, kFar);
            if (!hit)
                break;
            const float end = hit->distance + kTogether;
            const int crossings = crossingsAt(object, point, glm::dvec3(direction),
                                              std::max(start, hit->distance - kTogether), end);
            inside = inside != (crossings % 2 == 1);
            start = end;
        }
        votes += inside ? 1 : 0;
    }
    return votes >= 2;
}

} // namespace touchstone
