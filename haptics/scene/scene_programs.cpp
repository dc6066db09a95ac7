#include "haptics/scene/scene_programs.h"

#include "engine/core/error.h"
#include "engine/scene/program_frame.h"

#include <algorithm>
#include <memory>
#include <string>

namespace touchstone {

void addProgram(const Material& material, size_t index, const program::FeltProgram* before,
                HapticScene& haptic) {
    const MaterialProgram& stated = material.haptic.program;
    if (!stated)
        return;
    try {
        haptic.materials[index].program =
            std::make_shared<const program::FeltProgram>(program::feltProgram(stated, before));
    } catch (const Error& error) {
        haptic.warnings.push_back({"materials[" + std::to_string(index) + "].shader",
                                   error.file() + ": " + error.place() + ": " + error.problem() + "; " +
                                       error.remedy() + "; the surface is plain"});
    }
}

void placePrograms(const Scene& source, HapticScene& haptic) {
    haptic.programFromObject.clear();
    const bool any = std::ranges::any_of(
        haptic.materials, [](const HapticMaterialData& material) { return material.program != nullptr; });
    if (!any)
        return;
    for (const auto& object : haptic.objects) {
        const Similarity sceneFromObject =
            haptic.workspaceFromScene.inverseTimes(object->workspaceFromObject);
        if (object->instance < 0) { // not from the file: its own axes, metres of the scene
            haptic.programFromObject.push_back({.scale = sceneFromObject.scale});
            continue;
        }
        const Instance& instance = source.instances[static_cast<size_t>(object->instance)];
        haptic.programFromObject.push_back(
            sceneFromProgram(instance.sceneFromMesh).inverseTimes(sceneFromObject));
    }
}

} // namespace touchstone
