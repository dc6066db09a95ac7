#include "workbench/editor/texture_saving.h"

#include "haptics/program/felt_program.h"

#include <span>
#include <utility>

namespace touchstone {

namespace {

/// What the file has of an object that is hidden or cut away now, and so has no texture; empty: nothing.
std::span<const float> keptValues(const HapticScene& haptic, const HapticObject& object) {
    const auto& felt = haptic.materials[static_cast<size_t>(object.material)].program;
    if (!object.empty() || felt == nullptr || felt->start == nullptr)
        return {};
    const auto kept = felt->start->of(object.instance); // whose owner is `haptic`
    return kept != nullptr ? std::span<const float>(*kept) : std::span<const float>();
}

} // namespace

TexturesToSave texturesToSave(const Scene& source, const HapticScene& haptic,
                              const PersistentTextures* textures) {
    TexturesToSave all;
    const std::vector<int> surfaces = surfacesOf(source);
    for (size_t k = 0; textures != nullptr && k < haptic.objects.size(); ++k) {
        const PersistentTexture* const texture = textures->at(static_cast<int>(k));
        const HapticObject& object = *haptic.objects[k];
        if (object.instance < 0 || object.material < 0)
            continue;
        const bool felt = texture != nullptr && (texture->revision() != 0 || texture->start() != nullptr);
        const std::span<const float> values = felt ? texture->values() : keptValues(haptic, object);
        if (values.empty())
            continue;
        const auto instance = static_cast<size_t>(object.instance);
        const int file = source.materials[static_cast<size_t>(object.material)].fileIndex;
        const int node = source.instances[instance].node;
        if (file < 0 || node < 0)
            continue;
        all[static_cast<size_t>(file)].push_back({node, surfaces[instance], {values.begin(), values.end()}});
    }
    return all;
}

MaterialPatches withTextures(MaterialPatches patches, const TexturesToSave& textures) {
    for (const auto& [material, objects] : textures) {
        nlohmann::ordered_json& patch = patches[material];
        if (patch.contains("shader") && patch["shader"].is_null())
            continue; // the program is taken out, and the texture with it
        patch["shader"]["persistentTexture"]["values"] = jsonOf(objects);
    }
    return patches;
}

void TextureWatch::look(const PersistentTextures* textures) {
    const bool other = std::exchange(of_, textures) != textures;
    now_ = 0;
    for (size_t k = 0; textures != nullptr && k < textures->objects(); ++k)
        if (const PersistentTexture* const texture = textures->at(static_cast<int>(k)))
            now_ += texture->revision();
    if (other)
        saved_ = 0;
}

} // namespace touchstone
