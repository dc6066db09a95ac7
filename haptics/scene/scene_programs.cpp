#include "haptics/scene/scene_programs.h"

#include "engine/core/error.h"
#include "engine/import/materials/texture_values.h"
#include "engine/scene/program_frame.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// What the file has of the textures of `felt`; null: nothing. Throws Error where that is damaged.
std::shared_ptr<const program::StartTextures> startTextures(const Scene& source, const Material& material,
                                                            const std::string& place,
                                                            const program::FeltProgram& felt,
                                                            const program::FeltProgram* before) {
    const nlohmann::json& shader = material.says.ours.shader;
    const auto declared = shader.is_object() ? shader.find("persistentTexture") : shader.end();
    if (felt.texture.width == 0 || declared == shader.end() || !declared->is_object() ||
        !declared->contains("values"))
        return nullptr;
    const nlohmann::json& stated = (*declared)["values"];
    if (before != nullptr && before->start != nullptr && before->start->size == felt.texture &&
        static_cast<const nlohmann::json&>(before->start->stated) == stated)
        return before->start;
    auto start = std::make_shared<program::StartTextures>();
    start->stated = KeptJson(stated);
    start->size = felt.texture;
    const LoadOptions options;
    const ImportContext context(source.path, options);
    const std::vector<int> surfaces = surfacesOf(source);
    for (TextureValues& object :
         readTextureValues(context, stated, felt.texture, place + ".persistentTexture.values"))
        for (size_t i = 0; i < surfaces.size(); ++i)
            if (source.instances[i].node == object.node && surfaces[i] == object.surface)
                start->values[static_cast<int>(i)] =
                    std::make_shared<const std::vector<float>>(std::move(object.values));
    return start;
}

} // namespace

void addProgram(const Scene& source, const Material& material, size_t index,
                const program::FeltProgram* before, HapticScene& haptic) {
    const MaterialProgram& stated = material.haptic.program;
    if (!stated)
        return;
    const std::string place = "materials[" + std::to_string(index) + "].shader";
    try {
        program::FeltProgram felt = program::feltProgram(stated, before);
        try {
            felt.start = startTextures(source, material, place, felt, before);
        } catch (const Error& error) {
            haptic.warnings.push_back(
                {error.place(), error.problem() + "; " + error.remedy() + "; the texture begins even"});
        }
        haptic.materials[index].program = std::make_shared<const program::FeltProgram>(std::move(felt));
    } catch (const Error& error) {
        haptic.warnings.push_back({place, error.file() + ": " + error.place() + ": " + error.problem() +
                                              "; " + error.remedy() + "; the surface is plain"});
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

namespace {

/// What the object's material declares; without texels where it has none.
PersistentTextureSize textureOf(const HapticScene& haptic, const HapticObject& object) {
    const HapticMaterialData& material = haptic.materials[static_cast<size_t>(object.material)];
    return material.program != nullptr ? material.program->texture : PersistentTextureSize{};
}

std::shared_ptr<const std::vector<float>> startOf(const HapticScene& haptic, const HapticObject& object) {
    const auto& start = haptic.materials[static_cast<size_t>(object.material)].program->start;
    return start != nullptr ? start->of(object.instance) : nullptr;
}

/// A part of a scene has the warnings of the whole.
void warnOnce(HapticScene& haptic, Warning warning) {
    if (std::ranges::none_of(haptic.warnings, [&](const Warning& known) {
            return known.place == warning.place && known.message == warning.message;
        }))
        haptic.warnings.push_back(std::move(warning));
}

} // namespace

void placeTexels(const HapticScene* before, HapticScene& haptic, const Progress& progress) {
    haptic.texels.clear();
    const size_t count = haptic.objects.size();
    for (size_t k = 0; k < count; ++k) {
        const HapticObject& object = *haptic.objects[k];
        const PersistentTextureSize size = textureOf(haptic, object);
        std::shared_ptr<const TexelMap> kept;
        if (before != nullptr && k < before->texels.size() && before->objects[k] == haptic.objects[k])
            kept = before->texels[k];
        if (size.width == 0 || (object.empty() && kept == nullptr))
            continue;
        haptic.texels.resize(count);
        std::shared_ptr<const TexelMap>& texels = haptic.texels[k];
        texels = std::move(kept);
        if (texels == nullptr || texels->width() != size.width || texels->height() != size.height)
            texels = TexelMap::of(object, size.width, size.height,
                                  progress.part(static_cast<double>(k) / static_cast<double>(count),
                                                static_cast<double>(k + 1) / static_cast<double>(count)));
        if (texels == nullptr)
            warnOnce(haptic,
                     {object.name,
                      "has no texture coordinates that a persistent texture can follow: the program of "
                      "its material reads the initial value, and touch changes nothing; give the mesh a "
                      "TEXCOORD_0 that repeats it a few times at most"});
    }
}

std::shared_ptr<PersistentTextures> persistentTextures(const HapticScene& haptic,
                                                       std::shared_ptr<PersistentTextures> goOn) {
    if (haptic.texels.empty())
        return nullptr;
    bool fits = goOn != nullptr && goOn->objects() == haptic.texels.size();
    for (size_t k = 0; k < haptic.texels.size() && fits; ++k) {
        const PersistentTexture* const texture = goOn->at(static_cast<int>(k));
        fits = (texture != nullptr ? texture->map() : nullptr) == haptic.texels[k] &&
               (texture == nullptr || texture->size() == textureOf(haptic, *haptic.objects[k]));
    }
    if (fits)
        return goOn;
    std::vector<std::unique_ptr<PersistentTexture>> textures(haptic.texels.size());
    for (size_t k = 0; k < textures.size(); ++k)
        if (haptic.texels[k] != nullptr)
            textures[k] = std::make_unique<PersistentTexture>(
                haptic.texels[k], textureOf(haptic, *haptic.objects[k]), startOf(haptic, *haptic.objects[k]));
    return std::make_shared<PersistentTextures>(std::move(textures));
}

} // namespace touchstone
