#include "workbench/model/shown_textures.h"

namespace touchstone {

void ShownTextures::show(const HapticScene& scene, const PersistentTextures* textures,
                         SceneRenderer& renderer) {
    if (textures == nullptr)
        return;
    const bool fresh = textures != of_ || renderer.sceneNumber() != sceneNumber_;
    of_ = textures;
    sceneNumber_ = renderer.sceneNumber();
    if (fresh)
        shown_.assign(textures->objects(), 0);
    for (size_t k = 0; k < textures->objects() && k < scene.objects.size(); ++k) {
        const PersistentTexture* const texture = textures->at(static_cast<int>(k));
        if (texture == nullptr || (!fresh && texture->revision() == shown_[k]))
            continue;
        const uint64_t shown = fresh || texture->revision() < shown_[k] ? 0 : shown_[k];
        for (uint32_t tile = 0; tile < texture->tiles(); ++tile) {
            if (shown > 0 && texture->tileRevision(tile) <= shown)
                continue;
            const PersistentTexture::Place at = texture->placeOf(tile);
            const uint32_t width = texture->size().width;
            renderer.setTexels({.instance = scene.objects[k]->instance,
                                .textureWidth = width,
                                .textureHeight = texture->size().height,
                                .x = at.x,
                                .y = at.y,
                                .width = at.width,
                                .height = at.height,
                                .values = texture->values().data() + size_t{at.y} * width + at.x});
        }
        shown_[k] = texture->revision();
    }
}

} // namespace touchstone
