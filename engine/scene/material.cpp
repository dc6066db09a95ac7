#include "engine/scene/material.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

glm::vec2 TextureRef::transform(const glm::vec2& uv) const {
    // KHR_texture_transform: scale, then rotate counter-clockwise as seen in the image (v points down), then
    // translate.
    const float c = std::cos(rotation), s = std::sin(rotation);
    const glm::vec2 scaled = scale * uv;
    return offset + glm::vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
}

std::array<TextureRef*, kLookTextures> Material::lookTextures() {
    return {
        &baseColorTexture,     &metallicRoughnessTexture,     &normalTexture,      &occlusionTexture,
        &emissiveTexture,      &specularGlossiness.texture,   &specular.texture,   &specular.colorTexture,
        &clearcoat.texture,    &clearcoat.roughnessTexture,   &sheen.colorTexture, &sheen.roughnessTexture,
        &transmission.texture, &transmission.thicknessTexture};
}

std::array<const TextureRef*, kLookTextures> Material::lookTextures() const {
    std::array<const TextureRef*, kLookTextures> textures{};
    const auto mutableOnes = const_cast<Material*>(this)->lookTextures(); // only the addresses are taken
    std::copy(mutableOnes.begin(), mutableOnes.end(), textures.begin());
    return textures;
}

} // namespace touchstone
