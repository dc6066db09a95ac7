#include "workbench/files/sculpted_file.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/import/mesh_file/surface_glb.h"
#include "haptics/shape/field/save/field_export.h"

#include <string_view>

namespace touchstone {

size_t writeSculpted(const std::filesystem::path& file, const HapticScene& scene, size_t object) {
    const std::shared_ptr<const FieldGrid> field = fieldOfObject(scene, object);
    const Similarity place = sceneFromObject(scene, object);
    const std::string& name = scene.objects[object]->name;
    if (file.extension() == ".vdb") {
        writeFile(file, vdbOfField(*field, place, name));
        return 0;
    }
    const SurfaceMesh mesh = meshOfField(field, place, colorsOfObject(scene, object).get());
    if (mesh.corners.empty())
        throw Error(file.string(), "", "has no surface: everything was taken away", "undo a stroke");
    const std::vector<uint8_t> glb =
        glbOfSurface(mesh, name, "Touchstone " TOUCHSTONE_VERSION ", sculpted", file.string());
    writeFile(file, std::string_view(reinterpret_cast<const char*>(glb.data()), glb.size()));
    return mesh.corners.size() / 3;
}

} // namespace touchstone
