#include "engine/import/mesh_file/surface_glb.h"

#include "engine/import/mesh_file/flat_glb.h"

#include <cstring>

namespace touchstone {

std::vector<uint8_t> glbOfSurface(const SurfaceMesh& surface, const std::string& name,
                                  const std::string& generator, const std::string& shownAs) {
    std::vector<uint8_t> arrays;
    FlatMeshes meshes;
    FlatMesh& mesh = meshes.meshes.emplace_back();
    meshes.materials.emplace_back("surface");
    mesh.name = name;
    mesh.counts.vertices = static_cast<uint32_t>(surface.positions.size());
    mesh.counts.triangles = static_cast<uint32_t>(surface.corners.size() / 3);
    arrays.resize(surface.positions.size() * 2 * sizeof(glm::vec3) +
                  surface.colors.size() * sizeof(glm::vec4) + surface.corners.size() * sizeof(uint32_t));
    size_t at = 0;
    const auto put = [&](const auto& values) {
        const FlatRange range{at, values.size() * sizeof values[0]};
        std::memcpy(arrays.data() + at, values.data(), range.bytes);
        at += range.bytes;
        return range;
    };
    mesh.positions = put(surface.positions);
    mesh.normals = put(surface.normals);
    if (!surface.colors.empty())
        mesh.colors = put(surface.colors);
    mesh.corners = put(surface.corners);
    meshes.arrays = arrays;
    return glbOf(meshes, generator, shownAs);
}

} // namespace touchstone
