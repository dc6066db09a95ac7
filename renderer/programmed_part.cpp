#include "renderer/programmed_part.h"

#include "engine/scene/mesh_vertices.h"
#include "renderer/prepared_scene.h"

#include <vector>

namespace touchstone {

namespace {

/// One triangle with all that vertices of this mesh have.
Mesh firstTriangle(const Mesh& mesh) {
    Mesh one;
    one.material = mesh.material;
    one.normalsFromFile = mesh.normalsFromFile;
    one.tangentsFromFile = mesh.tangentsFromFile;
    forEachVertexArray(mesh, one, [&](const auto& from, auto& to) {
        for (size_t corner = 0; corner < 3 && !from.empty(); ++corner)
            to.push_back(from[mesh.indices[corner]]);
    });
    one.indices = {0, 1, 2};
    return one;
}

void takeImages(const Scene& scene, const Material& material, std::vector<Image>& images) {
    for (const TextureRef* const reference : material.lookTextures())
        if (usableTexture(scene, *reference)) {
            const auto image = static_cast<size_t>(reference->image);
            if (!images[image].decoded)
                images[image] = scene.images[image];
        }
}

} // namespace

ScenePtr programmedPart(const Scene& scene, const std::vector<MaterialProgram>& programs) {
    auto part = std::make_shared<Scene>();
    part->path = scene.path;
    part->bounds = scene.bounds;
    part->materials = scene.materials;
    part->images.resize(scene.images.size());
    part->nodes.emplace_back();
    for (size_t m = 0; m < part->materials.size(); ++m)
        part->materials[m].haptic.program = m < programs.size() ? programs[m] : MaterialProgram{};
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = part->materials[static_cast<size_t>(mesh.material)];
        if (!material.haptic.program || mesh.indices.empty())
            continue;
        takeImages(scene, material, part->images);
        part->instances.push_back({.node = 0, .mesh = static_cast<int>(part->meshes.size())});
        part->meshes.push_back(firstTriangle(mesh));
    }
    return part->instances.empty() ? nullptr : part;
}

} // namespace touchstone
