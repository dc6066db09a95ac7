#include "engine/import/volume_file/volume_scene.h"

#include "engine/import/mesh_file/flat_glb.h"
#include "engine/volume/volume_mesh.h"

#include <cstring>
#include <filesystem>

namespace touchstone {

std::vector<uint8_t> glbOfVolume(ImportContext& context, const Volume& volume, double iso) {
    std::vector<uint8_t> arrays;
    FlatMeshes meshes;
    FlatMesh& mesh = meshes.meshes.emplace_back();
    meshes.materials.emplace_back("surface");
    mesh.name = std::filesystem::path(context.file()).stem().string();
    {
        const SurfaceMesh surface =
            meshOfVolume(volume, iso, context.file(), context.progress().part(0.13, 0.2));
        if (surface.stride > 1)
            context.warn("volume", "is drawn from every " + std::to_string(surface.stride) +
                                       (surface.stride == 2   ? "nd"
                                        : surface.stride == 3 ? "rd"
                                                              : "th") +
                                       " voxel: the hand feels more than the eye sees");
        mesh.counts.vertices = static_cast<uint32_t>(surface.positions.size());
        mesh.counts.triangles = static_cast<uint32_t>(surface.corners.size() / 3);
        arrays.resize(surface.positions.size() * 2 * sizeof(glm::vec3) +
                      surface.corners.size() * sizeof(uint32_t));
        size_t at = 0;
        const auto put = [&](const auto& values) {
            const FlatRange range{at, values.size() * sizeof values[0]};
            std::memcpy(arrays.data() + at, values.data(), range.bytes);
            at += range.bytes;
            return range;
        };
        mesh.positions = put(surface.positions);
        mesh.normals = put(surface.normals);
        mesh.corners = put(surface.corners);
    }
    meshes.arrays = arrays;
    return glbOf(meshes, "Touchstone " TOUCHSTONE_VERSION ", from " + volume.facts().format, context.file());
}

} // namespace touchstone
