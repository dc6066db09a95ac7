#include "engine/import/volume_file/volume_scene.h"

#include "engine/import/mesh_file/surface_glb.h"
#include "engine/volume/volume_mesh.h"

#include <filesystem>
#include <string>

namespace touchstone {

std::vector<uint8_t> glbOfVolume(ImportContext& context, const Volume& volume, double iso) {
    const SurfaceMesh surface = meshOfVolume(volume, iso, context.file(), context.progress().part(0.13, 0.2));
    if (surface.stride > 1)
        context.warn("volume", "is drawn from every " + std::to_string(surface.stride) +
                                   (surface.stride == 2   ? "nd"
                                    : surface.stride == 3 ? "rd"
                                                          : "th") +
                                   " voxel: the hand feels more than the eye sees");
    return glbOfSurface(surface, std::filesystem::path(context.file()).stem().string(),
                        "Touchstone " TOUCHSTONE_VERSION ", from " + volume.facts().format, context.file());
}

} // namespace touchstone
