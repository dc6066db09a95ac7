#include "engine/import/geometry/mesh_build.h"

#include "engine/import/file/json_fields.h"
#include "engine/import/geometry/gltf_accessors.h"
#include "engine/import/geometry/morph.h"
#include "engine/import/geometry/primitive_restart.h"
#include "engine/import/geometry/texture_mapping.h"
#include "engine/import/geometry/vertex_attributes.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/scene/mesh_vertices.h"
#include "engine/scene/tangent_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace touchstone {
namespace {

/// Working memory of generateTangents per triangle, for the corners' welds, edges, groups and splits.
constexpr uint64_t kTangentBytesPerTriangle = 400;

/// A vertex of a line or point in the renderer's memory.
constexpr uint64_t kDrawnVertexBytes = 64;

/// Corners of triangle `i` of a strip or fan (glTF 2.0, section 3.7.2.1); a strip's odd triangles are
/// reversed.
std::array<size_t, 3> triangleOf(int mode, size_t i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        return {i, i + 1 + i % 2, i + 2 - i % 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        return {i + 1, i + 2, 0};
    return {3 * i, 3 * i + 1, 3 * i + 2};
}

/// The drawn vertices: the indices, or 0, 1, 2, ... without them. All in range.
std::vector<uint32_t> drawnVertices(ImportContext& context, const GltfDocument& document,
                                    const tinygltf::Primitive& primitive, DracoPrimitive* draco,
                                    size_t vertexCount, const std::string& place) {
    std::vector<uint32_t> drawn;
    if (draco != nullptr) {
        drawn = std::move(draco->indices);
    } else if (primitive.indices >= 0) {
        drawn = readIndices(context, document, primitive.indices, place + ".indices");
        drawn = withoutRestarts(context, std::move(drawn), restartIndex(document, primitive.indices),
                                vertexCount, primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode,
                                place + ".indices");
    } else {
        context.spendGeometry(vertexCount * sizeof(uint32_t), place);
        drawn.resize(vertexCount);
        for (size_t i = 0; i < vertexCount; ++i)
            drawn[i] = static_cast<uint32_t>(i);
    }
    for (const uint32_t index : drawn)
        if (index >= vertexCount)
            context.fail(place + ".indices", "index " + std::to_string(index) + " exceeds " +
                                                 std::to_string(vertexCount - 1) + ", the last vertex");
    return drawn;
}

std::vector<uint32_t> triangleList(ImportContext& context, std::vector<uint32_t> drawn, int mode,
                                   const std::string& place) {
    const bool list = mode == TINYGLTF_MODE_TRIANGLES;
    const size_t triangles = list ? drawn.size() / 3 : drawn.size() < 3 ? 0 : drawn.size() - 2;
    if (list && drawn.size() % 3 != 0)
        context.warn(place, "its number of indices is no multiple of three; the rest is ignored");
    std::vector<uint32_t> indices;
    if (!list)
        context.spendGeometry(triangles * 3 * sizeof(uint32_t), place);
    indices.reserve(triangles * 3);
    size_t degenerate = 0;
    for (size_t i = 0; i < triangles; ++i) {
        const auto [a, b, c] = triangleOf(mode, i);
        const uint32_t va = drawn[a], vb = drawn[b], vc = drawn[c];
        if (va == vb || vb == vc || vc == va)
            ++degenerate; // in a strip they are stitches, not flaws
        else
            indices.insert(indices.end(), {va, vb, vc});
    }
    if (degenerate > 0 && mode != TINYGLTF_MODE_TRIANGLE_STRIP)
        context.warn(place, std::to_string(degenerate) + " triangles use a vertex twice and were dropped");
    return indices;
}

/// Lines, strips and loops as segments; a segment from a vertex to itself is dropped.
std::vector<uint32_t> segmentList(ImportContext& context, const std::vector<uint32_t>& drawn, int mode,
                                  const std::string& place) {
    const bool list = mode == TINYGLTF_MODE_LINE, loop = mode == TINYGLTF_MODE_LINE_LOOP;
    if (list && drawn.size() % 2 != 0)
        context.warn(place, "its number of indices is no multiple of two; the last one is ignored");
    const size_t count = list ? drawn.size() / 2 : drawn.size() < 2 ? 0 : drawn.size() - (loop ? 0 : 1);
    context.spendGeometry(count * 2 * sizeof(uint32_t), place);
    std::vector<uint32_t> segments;
    segments.reserve(2 * count);
    for (size_t i = 0; i < count; ++i) {
        const size_t first = list ? 2 * i : i;
        const uint32_t a = drawn[first], b = drawn[(first + 1) % drawn.size()];
        if (a != b)
            segments.insert(segments.end(), {a, b});
    }
    return segments;
}

glm::dvec3 faceNormal(const Mesh& mesh, size_t triangle) {
    const auto corner = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]); };
    return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

glm::vec3 unitOrUp(const glm::dvec3& v) {
    // Scaled first: areas of models of any size must neither overflow nor vanish when squared.
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0.0 ? glm::vec3(glm::normalize(v / largest)) : glm::vec3(0.0f, 0.0f, 1.0f);
}

/// Gives every triangle its own vertices and normal (glTF 2.0, section 3.7.2.1: "flat normals").
void makeFlat(ImportContext& context, Mesh& mesh, const std::string& place) {
    const size_t corners = mesh.indices.size();
    mesh.tangents = {}; // by the specification the file's tangents are ignored without normals
    mesh.tangentsFromFile = false;
    context.spendGeometry(corners * bytesPerVertex(mesh), place);
    selectVertices(mesh, mesh.indices);
    for (size_t i = 0; i < corners; ++i)
        mesh.indices[i] = static_cast<uint32_t>(i);
    context.spendGeometry(corners * sizeof(glm::vec3), place);
    mesh.normals.resize(corners);
    for (size_t i = 0; i < corners; ++i)
        mesh.normals[i] = unitOrUp(faceNormal(mesh, i / 3));
}

/// Replaces normals of length zero by the area-weighted mean of the adjacent triangles.
void mendNormals(Mesh& mesh) {
    const auto lost = [](const glm::vec3& n) { return n == glm::vec3(0.0f); };
    if (std::none_of(mesh.normals.begin(), mesh.normals.end(), lost))
        return;
    std::vector<glm::dvec3> sum(mesh.positions.size(), glm::dvec3(0.0));
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        sum[mesh.indices[i]] += faceNormal(mesh, i / 3);
    for (size_t v = 0; v < sum.size(); ++v)
        if (lost(mesh.normals[v]))
            mesh.normals[v] = unitOrUp(sum[v]);
}

/// Primitives that are drawn but not touched: no flat normals, since without normals they are drawn unlit
/// (glTF 2.0, section 3.7.2.1), and no tangents.
void makeDrawnOnly(ImportContext& context, std::vector<uint32_t> drawn, int mode, const std::string& place,
                   Mesh& mesh) {
    context.warn(place, "holds points or lines: they are drawn, but cannot be touched");
    if (mode == TINYGLTF_MODE_POINTS)
        mesh.pointIndices = std::move(drawn);
    else
        mesh.lineIndices = segmentList(context, drawn, mode, place);
    // The renderer has a vertex for each index: a few vertices with many small indices must not become
    // gigabytes.
    context.spendGeometry((mesh.lineIndices.size() + mesh.pointIndices.size()) * kDrawnVertexBytes, place);
    mesh.tangents = {};
    mesh.tangentsFromFile = false;
}

void settleTangents(ImportContext& context, Mesh& mesh, const Material& material, const std::string& place) {
    const TextureRef& map = material.normalTexture         ? material.normalTexture
                            : material.haptic.height.value ? material.haptic.height.value->texture
                                                           : TextureRef{};
    const bool hasUv = !(map.texCoord == 1 ? mesh.uv1 : mesh.uv0).empty();
    if (!map || !hasUv) {
        mesh.tangents = {};
        mesh.tangentsFromFile = false;
        if (map)
            context.warn(place, "has no TEXCOORD_" + std::to_string(map.texCoord) +
                                    " for its normal or height map; drawn and felt without it");
        return;
    }
    if (!mesh.tangents.empty())
        return;
    context.spendGeometry(mesh.triangleCount() * kTangentBytesPerTriangle, place);
    constexpr double kTimePerTriangle = 1.5e-6; // s
    const EstimatedProgress estimate(context.part().part(0.5, 1.0), "making tangents",
                                     kTimePerTriangle * static_cast<double>(mesh.triangleCount()));
    generateTangents(mesh, map.texCoord, context.part().silent()); // the estimate reports
}

/// The texture coordinates of a material that makes its own.
void applyMapping(ImportContext& context, const GltfDocument& document, int material, Mesh& mesh) {
    (void)context.attempt("the mesh keeps its own coordinates", [&] {
        std::string place;
        const std::optional<TextureMapping> mapping = readTextureMapping(context, document, material, place);
        if (!mapping)
            return;
        context.spendGeometry(mesh.indices.size() * sizeof(glm::vec2) * 4, place);
        (void)mapTexture(*mapping, mesh);
    });
}

/// The displacements of `attribute` by a target; empty where it has none. MorphTargets::displace refuses what
/// it cannot use, which here costs the displacement alone: the static pose is right without it.
std::vector<glm::vec3> displacements(ImportContext& context, const GltfDocument& document,
                                     const std::map<std::string, int>& target, const char* attribute,
                                     size_t vertices, const std::string& place) {
    const auto found = target.find(attribute);
    if (found == target.end() || !accessorHasData(document, found->second))
        return {};
    const std::string at = place + "." + attribute;
    std::vector<glm::vec3> result;
    (void)context.attempt("it does not move", [&] {
        if (accessorComponents(document, found->second) != 3)
            context.fail(at, "has no three components");
        if (accessorCount(document, found->second) != vertices)
            context.fail(at, "has " + std::to_string(accessorCount(document, found->second)) +
                                 " vertices where the attribute has " + std::to_string(vertices));
        const std::vector<float> values = readFloats(context, document, found->second, at);
        if (std::any_of(values.begin(), values.end(), [](float value) { return !std::isfinite(value); }))
            context.fail(at, "has a number that is not finite");
        context.spendGeometry(vertices * sizeof(glm::vec3), at);
        result.resize(vertices);
        for (size_t v = 0; v < vertices; ++v)
            result[v] = {values[3 * v], values[3 * v + 1], values[3 * v + 2]};
    });
    return result;
}

/// What moves the primitive's vertices: those of the file, undisplaced and unposed. Null where nothing does.
std::shared_ptr<MeshDeformation> deformationOf(ImportContext& context, const GltfDocument& document,
                                               const tinygltf::Primitive& primitive,
                                               std::optional<DracoPrimitive> draco, const MeshPose& pose,
                                               const std::string& place) {
    const bool bends = pose.skin != nullptr && pose.skin->driven;
    const bool morphs = pose.weightsNode >= 0 && !primitive.targets.empty();
    if (!bends && !morphs)
        return nullptr;
    auto deformation = std::make_shared<MeshDeformation>();
    Mesh base;
    readVertexAttributes(context, document, primitive, draco ? &*draco : nullptr,
                         MorphTargets(context, document, primitive, {}, place), place, base);
    const size_t vertices = base.positions.size();
    deformation->positions = std::move(base.positions);
    deformation->normals = std::move(base.normals);
    for (size_t t = 0; t < primitive.targets.size(); ++t) {
        const std::string at = place + "." + element("targets", t);
        const auto& target = primitive.targets[t];
        deformation->weights.push_back(t < pose.weights.size() ? pose.weights[t] : 0.0);
        deformation->targets.push_back(
            {displacements(context, document, target, "POSITION", vertices, at),
             deformation->normals.empty()
                 ? std::vector<glm::vec3>()
                 : displacements(context, document, target, "NORMAL", vertices, at)});
    }
    deformation->weightsNode = morphs ? pose.weightsNode : -1;
    return deformation;
}

bool hasData(const GltfDocument& document, const tinygltf::Primitive& primitive) {
    return (primitive.indices < 0 || accessorHasData(document, primitive.indices)) &&
           std::all_of(primitive.attributes.begin(), primitive.attributes.end(),
                       [&](const auto& attribute) { return accessorHasData(document, attribute.second); });
}

} // namespace

std::optional<PosedMesh> buildMesh(ImportContext& context, const GltfDocument& document, size_t meshIndex,
                                   size_t primitiveIndex, const Material& material, const MeshPose& pose) {
    const tinygltf::Mesh& gltf = document.model.meshes[meshIndex];
    const tinygltf::Primitive& primitive = gltf.primitives[primitiveIndex];
    const std::string place = element("meshes", meshIndex) + "." + element("primitives", primitiveIndex);
    const nlohmann::json& stated = document.json["meshes"][meshIndex]["primitives"][primitiveIndex];
    context.stopIfCancelled();

    // A name may be most of the file, and every mesh and every material has a copy.
    context.spendGeometry(sizeof(Mesh) + sizeof(Material) + gltf.name.size() + material.name.size(), place);
    if (!hasData(document, primitive)) {
        context.warn(place, "its buffer is declared without data: the mesh is left out");
        return std::nullopt;
    }
    std::optional<DracoPrimitive> draco;
    if (const auto* extension = extensionOf(context, stated, "KHR_draco_mesh_compression", place))
        draco = decodeDraco(context, document, *extension, primitive,
                            place + ".extensions.KHR_draco_mesh_compression");

    PosedMesh posed;
    Mesh& mesh = posed.mesh;
    mesh.name = gltf.name;
    std::shared_ptr<MeshDeformation> deformation =
        deformationOf(context, document, primitive, draco, pose, place);
    const MorphTargets morph(context, document, primitive, pose.weights, place);
    readVertexAttributes(context, document, primitive, draco ? &*draco : nullptr, morph, place, mesh);
    if (mesh.positions.empty()) {
        context.warn(place, "has no POSITION: there is nothing to show or touch in it");
        return std::nullopt;
    }
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    context.part().step(0.3, "reading indices");
    auto drawn =
        drawnVertices(context, document, primitive, draco ? &*draco : nullptr, mesh.positions.size(), place);
    context.part().step(0.4, "making triangles");
    if (mode < TINYGLTF_MODE_TRIANGLES)
        makeDrawnOnly(context, std::move(drawn), mode, place, mesh);
    else
        mesh.indices = triangleList(context, std::move(drawn), draco ? TINYGLTF_MODE_TRIANGLES : mode, place);
    // Flat, repaired and generated normals and tangents are those of the posed surface.
    bool skinned = false;
    if (pose.skin != nullptr)
        if (auto influences = readInfluences(context, document, primitive, draco ? &*draco : nullptr,
                                             *pose.skin, mesh.positions.size(), place)) {
            posed.origin = poseVertices(context, *influences, *pose.skin, place, mesh);
            skinned = true;
            if (deformation != nullptr) {
                deformation->joints = pose.skin->joints;
                deformation->jointFromMesh = pose.skin->jointFromMesh;
                deformation->perVertex = influences->perVertex;
                deformation->vertexJoints = std::move(influences->joints);
                deformation->vertexWeights = std::move(influences->weights);
                deformation->sceneFromSkin = *posed.origin;
            }
        }
    if (deformation != nullptr && (skinned || deformation->weightsNode >= 0)) {
        mesh.sources.resize(mesh.positions.size());
        std::iota(mesh.sources.begin(), mesh.sources.end(), 0u);
        mesh.deformation = std::move(deformation);
    }
    // An unused vertex would affect the frame of the touched object, its tolerances and its rounding; and
    // placed meshes count by what they draw.
    dropUnusedVertices(mesh);
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        mendNormals(mesh);
        checkMesh(mesh, context.file(), place);
        return posed;
    }
    if (!mesh.normalsFromFile)
        makeFlat(context, mesh, place);
    else
        mendNormals(mesh);
    applyMapping(context, document, primitive.material, mesh);
    settleTangents(context, mesh, material, place);
    checkMesh(mesh, context.file(), place);
    return posed;
}

} // namespace touchstone
