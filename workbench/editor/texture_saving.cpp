#include "workbench/editor/texture_saving.h"

#include <utility>

namespace touchstone {

TexturesToSave texturesToSave(const Scene& source, const HapticScene& haptic,
                              const PersistentTextures* textures) {
    TexturesToSave all;
    for (size_t k = 0; textures != nullptr && k < haptic.objects.size(); ++k) {
        const PersistentTexture* const texture = textures->at(static_cast<int>(k));
        const HapticObject& object = *haptic.objects[k];
        if (texture == nullptr || object.instance < 0 || object.material < 0 ||
            (texture->revision() == 0 && texture->start() == nullptr))
            continue;
        const int file = source.materials[static_cast<size_t>(object.material)].fileIndex;
        const int node = source.instances[static_cast<size_t>(object.instance)].node;
        if (file < 0 || node < 0)
            continue;
        int surface = 0;
        for (int i = 0; i < object.instance; ++i)
            surface += source.instances[static_cast<size_t>(i)].node == node ? 1 : 0;
        all[static_cast<size_t>(file)].push_back(
            {node, surface, {texture->values().begin(), texture->values().end()}});
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
