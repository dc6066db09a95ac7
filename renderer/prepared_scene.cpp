#include "renderer/prepared_scene.h"

#include "engine/scene/mesh_vertices.h"
#include "renderer/material_features.h"

#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace touchstone {

namespace {

constexpr int kLargestTexture = 16384; // of any device; smaller ones omit the largest levels

/// Of the triangles that every three of `indices` are.
double meanEdge(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
    double sum = 0.0;
    for (size_t i = 0; i + 2 < indices.size(); i += 3)
        for (size_t corner = 0; corner < 3; ++corner)
            sum += static_cast<double>(
                glm::distance(positions[indices[i + corner]], positions[indices[i + (corner + 1) % 3]]));
    return indices.empty() ? 0.0 : sum / static_cast<double>(indices.size());
}

/// Repeatedly halves the number of triangles. The error of a step is relative to the previous level and as
/// often inwards as outwards: the squares add up.
void simplify(const Mesh& mesh, const PrepareOptions& options, const Progress& progress,
              std::vector<uint32_t>& indices, PreparedMesh& out) {
    constexpr double kTimePerTriangle = 1e-6; // s, of one halving
    const float* positions = &mesh.positions[0].x;
    const auto scale =
        static_cast<double>(meshopt_simplifyScale(positions, mesh.positions.size(), sizeof(glm::vec3)));
    std::vector<uint32_t> current = mesh.indices, coarser(mesh.indices.size());
    double squared = 0.0, done = 0.0; // each halving takes half of the time of the previous one
    while (options.coarsest > 0 && current.size() / 3 > 2 * options.coarsest) {
        if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed))
            return;
        const double after = 0.5 * (1.0 + done);
        const EstimatedProgress estimate(progress.part(done, after), "simplifying what is drawn",
                                         kTimePerTriangle * static_cast<double>(current.size() / 3));
        done = after;
        float step = 0.0f;
        const size_t target = current.size() / 6 * 3;
        const size_t count =
            meshopt_simplify(coarser.data(), current.data(), current.size(), positions, mesh.positions.size(),
                             sizeof(glm::vec3), target, std::numeric_limits<float>::max(), 0, &step);
        if (count == 0 || count > current.size() / 10 * 9)
            return; // seams and borders prevent further simplification
        // Order for the vertex cache, which matters to software devices.
        current.resize(count);
        meshopt_optimizeVertexCache(current.data(), coarser.data(), count, mesh.positions.size());
        squared += scale * scale * static_cast<double>(step) * static_cast<double>(step);
        out.levels.push_back({static_cast<uint32_t>(indices.size()), static_cast<uint32_t>(count),
                              std::sqrt(squared), meanEdge(mesh.positions, current)});
        indices.insert(indices.end(), current.begin(), current.end());
    }
}

void prepareMesh(const Mesh& mesh, const PrepareOptions& options, const Progress& progress,
                 PreparedScene& out) {
    progress.report(0.0, "packing what is drawn");
    PreparedMesh prepared;
    prepared.firstVertex = static_cast<int32_t>(out.vertices.size());
    Bounds bounds;
    for (const glm::vec3& position : mesh.positions)
        bounds.include(glm::dvec3(position));
    if (!bounds.empty()) {
        prepared.centre = bounds.centre();
        prepared.halfSize = 0.5 * bounds.extent();
    }
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!mesh.indices.empty())
            out.vertices.push_back(packVertex(mesh, i, prepared.centre));
        prepared.radius =
            std::max(prepared.radius, glm::length(glm::dvec3(mesh.positions[i]) - prepared.centre));
    }
    prepared.levels.push_back({static_cast<uint32_t>(out.indices.size()),
                               static_cast<uint32_t>(mesh.indices.size()), 0.0,
                               meanEdge(mesh.positions, mesh.indices)});
    out.indices.insert(out.indices.end(), mesh.indices.begin(), mesh.indices.end());
    if (!mesh.indices.empty())
        simplify(mesh, options, progress.part(0.1, 1.0), out.indices, prepared);
    out.meshes.push_back(std::move(prepared));
}

/// After the vertices of all triangles, over which false-colour views index.
void prepareStrokes(const Mesh& mesh, PreparedMesh& prepared, std::vector<SceneVertex>& vertices) {
    prepared.strokeVertex = static_cast<uint32_t>(vertices.size());
    prepared.strokes = static_cast<uint32_t>(mesh.lineCount() + mesh.pointCount());
    for (const auto* indices : {&mesh.lineIndices, &mesh.pointIndices})
        for (const uint32_t index : *indices)
            vertices.push_back(packVertex(mesh, index, prepared.centre));
}

void prepareTextures(const PrepareOptions& options, PreparedScene& out) {
    const Scene& scene = *out.scene;
    for (const Material& material : scene.materials) {
        const auto references = material.lookTextures();
        for (size_t slot = 0; slot < references.size(); ++slot) {
            const TextureRef* reference = references[slot];
            const TextureRole role = kSlotRoles[slot];
            if (options.cancel != nullptr && options.cancel->load(std::memory_order_relaxed))
                return;
            if (!usableTexture(scene, *reference) || out.textures.count({reference->image, role}) != 0)
                continue;
            const PixelData& pixels = scene.images[static_cast<size_t>(reference->image)].pixels;
            out.textures.emplace(std::pair{reference->image, role},
                                 buildTextureLevels(pixels, role, kLargestTexture));
        }
    }
}

} // namespace

SceneVertex packVertex(const Mesh& mesh, size_t i, const glm::dvec3& centre) {
    SceneVertex vertex{};
    vertex.position = glm::vec3(glm::dvec3(mesh.positions[i]) - centre);
    vertex.normal = mesh.normals.empty() ? glm::vec3(0.0f, 0.0f, 1.0f) : mesh.normals[i];
    vertex.tangent = mesh.tangents.empty() ? glm::vec4(1.0f, 0.0f, 0.0f, 1.0f) : mesh.tangents[i];
    if (!mesh.uv0.empty())
        vertex.uv0 = mesh.uv0[i];
    if (!mesh.uv1.empty())
        vertex.uv1 = mesh.uv1[i];
    const glm::vec4 color = mesh.colors.empty() ? glm::vec4(1.0f) : glm::clamp(mesh.colors[i], 0.0f, 1.0f);
    for (int c = 0; c < 4; ++c)
        vertex.color[static_cast<size_t>(c)] = static_cast<uint16_t>(std::lround(65535.0f * color[c]));
    return vertex;
}

bool usableTexture(const Scene& scene, const TextureRef& reference) {
    if (!reference || static_cast<size_t>(reference.image) >= scene.images.size())
        return false;
    const PixelData& pixels = scene.images[static_cast<size_t>(reference.image)].pixels;
    return pixels.width > 0 && pixels.height > 0 && !pixels.bytes.empty();
}

const DrawLevel& levelWithin(const PreparedMesh& mesh, double allowed) {
    size_t level = 0;
    while (level + 1 < mesh.levels.size() && mesh.levels[level + 1].error <= allowed)
        ++level;
    return mesh.levels[level];
}

std::shared_ptr<const PreparedScene> prepareScene(ScenePtr scene, const PrepareOptions& options) {
    auto prepared = std::make_shared<PreparedScene>();
    prepared->scene = std::move(scene);
    size_t vertices = 0, indices = 0;
    for (const Mesh& mesh : prepared->scene->meshes) {
        checkMesh(mesh, prepared->scene->path, mesh.name);
        vertices +=
            mesh.indices.empty() ? mesh.lineIndices.size() + mesh.pointIndices.size() : mesh.positions.size();
        indices += mesh.indices.size();
    }
    prepared->vertices.reserve(vertices);
    prepared->indices.reserve(options.coarsest > 0 ? 2 * indices : indices);
    size_t done = 0;
    for (const Mesh& mesh : prepared->scene->meshes) {
        const size_t after = done + mesh.indices.size();
        const Progress part = options.progress.part(share(done, indices), share(after, indices));
        // A progress thread would take longer than a small mesh.
        constexpr size_t kWorthReporting = 300'000; // indices
        prepareMesh(mesh, options, mesh.indices.size() < kWorthReporting ? part.silent() : part, *prepared);
        part.report(1.0, "packing what is drawn");
        done = after;
    }
    for (size_t m = 0; m < prepared->meshes.size(); ++m)
        prepareStrokes(prepared->scene->meshes[m], prepared->meshes[m], prepared->vertices);
    prepareTextures(options, *prepared);
    return prepared;
}

} // namespace touchstone
