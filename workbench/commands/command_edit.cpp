// Edits haptic materials and saves them into the model's file.

#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "engine/save/material_patch.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/material_edits.h"
#include "workbench/editor/presets.h"
#include "workbench/editor/texture_fields.h"
#include "workbench/options/commands.h"

#include <algorithm>
#include <cstdio>

namespace touchstone {

namespace {

/// "0 rubber, 1 steel": the materials of the file.
std::string materialList(const Scene& scene, size_t count) {
    constexpr size_t kMax = 20;
    std::string list;
    for (size_t m = 0; m < std::min(count, kMax); ++m)
        list += (m == 0 ? "" : ", ") + std::to_string(m) +
                (scene.materials[m].name.empty() ? "" : " " + scene.materials[m].name);
    return count > kMax ? list + ", ..." : list;
}

/// The materials that an index, a name or "all" selects. The scene's first materials are the file's, in their
/// order.
std::vector<size_t> materialsNamed(const Scene& scene, size_t count, const std::string& wanted) {
    std::vector<size_t> found;
    for (size_t m = 0; m < count; ++m)
        if (wanted == "all" || scene.materials[m].name == wanted)
            found.push_back(m);
    for (size_t m = 0; m < count && found.empty(); ++m)
        if (std::to_string(m) == wanted)
            found.push_back(m);
    if (found.empty())
        throw Error(scene.path, "materials", "there is no '" + wanted + "'",
                    "name one of: " + materialList(scene, count) + "; or all");
    return found;
}

std::vector<size_t> chosenMaterials(const Scene& scene, size_t count, const EditOptions& options) {
    if (count == 0)
        throw Error(scene.path, "materials", "the file has none that could feel like something",
                    "give its surfaces a material in a modelling program");
    if (options.materials.empty() && count > 1)
        throw Error(scene.path, "materials", "there are " + std::to_string(count) + " of them",
                    "say which with --material: " + materialList(scene, count) + "; or all");
    std::vector<size_t> chosen;
    if (options.materials.empty())
        chosen.push_back(0);
    for (const std::string& wanted : options.materials)
        for (const size_t m : materialsNamed(scene, count, wanted))
            if (std::find(chosen.begin(), chosen.end(), m) == chosen.end())
                chosen.push_back(m);
    return chosen;
}

HapticStatement edited(HapticStatement statement, const Scene& scene, const EditOptions& options) {
    if (options.reset)
        statement = HapticStatement{};
    if (const MaterialPreset* preset = findPreset(options.preset))
        statement = withPreset(std::move(statement), *preset);
    for (const std::string& name : options.resetFields)
        if (!isMappingField(name) && !resetHapticField(statement, name))
            throw Error("--reset-field", "",
                        isPersistentField(name)
                            ? "'" + name + "' is nothing that the file says and could be without"
                            : "'" + name + "' is no parameter of the material's program",
                        "touchstone inspect " + scene.path + " lists them");
    for (const auto& [name, value] : options.fields)
        if (isMappingField(name))
            continue;
        else if (const std::string problem = setHapticField(statement, scene, name, value); !problem.empty())
            throw Error("--field", "", problem, "touchstone edit --help");
    return statement;
}

/// Adds what the fields say of where the material's texture coordinates come from.
void addMapping(const EditOptions& options, size_t material, MaterialPatches& patches) {
    const bool any =
        std::ranges::any_of(options.fields, [](const auto& f) { return isMappingField(f.first); });
    const bool gone = std::ranges::find(options.resetFields, "textureMapping") != options.resetFields.end();
    if (!any && !gone)
        return;
    const nlohmann::json before = mappingInFile(options.scene, material);
    nlohmann::json mapping = gone ? nlohmann::json() : before;
    for (const auto& [name, value] : options.fields)
        if (isMappingField(name))
            mapping = withMappingField(std::move(mapping), name, value);
    if (mapping == before)
        return;
    nlohmann::ordered_json patch(mapping);
    if (before.is_object() && mapping.is_object())
        for (const auto& [name, value] : before.items())
            if (!mapping.contains(name))
                patch[name] = nullptr;
    patches[material]["textureMapping"] = std::move(patch);
}

} // namespace

int editCommand(const EditOptions& options) {
    LoadOptions loading;
    loading.images = {.visual = false, .haptic = false};
    const ScenePtr scene = loadScene(options.scene, loading);
    MaterialEdits edits(*scene);
    const std::vector<size_t> chosen = chosenMaterials(*scene, edits.size(), options);
    for (const size_t m : chosen) {
        edits.change(m, edited(edits.now(m), *scene, options), "edit");
        edits.endGesture();
    }
    const std::filesystem::path target = options.out.empty() ? options.scene : options.out;
    MaterialPatches patches = edits.patches();
    for (const size_t m : chosen)
        addMapping(options, m, patches);
    (void)saveMaterials(options.scene, scene->file, patches, target);
    if (patches.empty())
        std::printf("%s already says so\n", options.scene.c_str());
    for (const auto& [index, patch] : patches)
        std::printf("materials[%zu] %s: %s\n", index, scene->materials[index].name.c_str(),
                    patch.dump().c_str());
    std::printf("saved to %s\n", target.c_str());
    return 0;
}

} // namespace touchstone
