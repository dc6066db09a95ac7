#include "engine/import/geometry/mesh_variants.h"

#include "engine/import/geometry/mesh_build.h"
#include "engine/import/materials/gltf_mpeg.h"
#include "engine/scene/mesh_vertices.h"

#include <limits>

namespace touchstone {
namespace {

uint64_t bytesOf(const Mesh& mesh) {
    const size_t indices = mesh.indices.size() + mesh.lineIndices.size() + mesh.pointIndices.size();
    return sizeof(Mesh) + sizeof(Material) + mesh.name.size() + mesh.positions.size() * bytesPerVertex(mesh) +
           indices * sizeof(mesh.indices[0]);
}

} // namespace

const std::vector<MeshVariant>& MeshVariants::get(const ShownMesh& shown) {
    asked_[shown.gltfMesh] = true;
    const auto [found, isNew] = made_.try_emplace(shown);
    if (isNew) {
        const std::vector<MeshVariant>* same = sameShape(found);
        found->second = same != nullptr ? copyAll(shown, *same) : buildAll(shown);
    }
    return found->second;
}

/// A variant that differs only in its physics material, and has something to draw; null if there is none.
const std::vector<MeshVariant>* MeshVariants::sameShape(Made::const_iterator found) const {
    ShownMesh first = found->first;
    first.physics = std::numeric_limits<int>::min();
    auto other = made_.lower_bound(first);
    if (other == found)
        ++other;
    if (other == made_.end() || other->second.empty())
        return nullptr;
    ShownMesh asFound = other->first;
    asFound.physics = found->first.physics;
    return asFound == found->first ? &other->second : nullptr;
}

int MeshVariants::materialFor(const ShownMesh& shown, size_t primitive) {
    const int mpeg = mpegMaterialOf(context_, document_, shown.gltfMesh).value_or(-1);
    return materials_.indexOf(
        {document_.model.meshes[shown.gltfMesh].primitives[primitive].material, mpeg, shown.physics});
}

std::vector<MeshVariant> MeshVariants::buildAll(const ShownMesh& shown) {
    const MeshPose pose{shown.weights,
                        shown.skin >= 0 ? &skins_.get(static_cast<size_t>(shown.skin)) : nullptr,
                        shown.weightsNode};
    std::vector<MeshVariant> variants;
    const Progress all = context_.part();
    const size_t primitives = document_.model.meshes[shown.gltfMesh].primitives.size();
    for (size_t p = 0; p < primitives; ++p) {
        context_.enter(all.part(share(p, primitives), share(p + 1, primitives)));
        const int material = materialFor(shown, p);
        auto posed = buildMesh(context_, document_, shown.gltfMesh, p, materials_.material(material), pose);
        if (!posed)
            continue;
        posed->mesh.material = material;
        variants.push_back({static_cast<int>(scene_.meshes.size()), posed->origin});
        keep(std::move(posed->mesh), p);
    }
    return variants;
}

std::vector<MeshVariant> MeshVariants::copyAll(const ShownMesh& shown, const std::vector<MeshVariant>& from) {
    std::vector<MeshVariant> variants;
    for (const MeshVariant& source : from) {
        const auto at = static_cast<size_t>(source.mesh);
        const size_t primitive = primitiveOf_[at];
        const Material& material = materials_.material(scene_.meshes[at].material);
        context_.spendGeometry(bytesOf(scene_.meshes[at]) + material.name.size(),
                               element("meshes", shown.gltfMesh));
        Mesh mesh = scene_.meshes[at];
        mesh.material = materialFor(shown, primitive);
        variants.push_back({static_cast<int>(scene_.meshes.size()), source.origin});
        keep(std::move(mesh), primitive);
    }
    return variants;
}

void MeshVariants::keep(Mesh mesh, size_t primitive) {
    scene_.meshes.push_back(std::move(mesh));
    primitiveOf_.push_back(primitive);
}

} // namespace touchstone
