#include "workbench/figures/texture_figures.h"

#include <algorithm>

namespace touchstone {

nlohmann::ordered_json texturesJson(const HapticScene& scene, const PersistentTextures* textures) {
    if (textures == nullptr)
        return nullptr;
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const PersistentTexture* const texture = textures->at(static_cast<int>(k));
        if (texture == nullptr)
            continue;
        const double side = scene.programFromObject[k].scale;
        const auto changed =
            std::ranges::count_if(texture->values(), [&](float v) { return v != texture->size().initial; });
        all.push_back({{"object", scene.objects[k]->name},
                       {"width", texture->size().width},
                       {"height", texture->size().height},
                       {"area_m2", texture->map()->area() * side * side},
                       {"mean", texture->mean()},
                       {"changed_texels", changed}});
    }
    return all;
}

} // namespace touchstone
