#pragma once
// Shader features and uniforms of a material; pipelines are specialised on the features. Pure; any thread.

#include "engine/scene/scene.h"
#include "renderer/texture_levels.h"
#include "shaders/shared/scene_types.h"

#include <array>

namespace touchstone {

/// The contents of the texture in each slot (Material::lookTextures).
inline constexpr std::array<TextureRole, kLookTextures> kSlotRoles{
    TextureRole::Color, TextureRole::Data, TextureRole::Data,  TextureRole::Data, TextureRole::Color,
    TextureRole::Color, TextureRole::Data, TextureRole::Color, TextureRole::Data, TextureRole::Data,
    TextureRole::Color, TextureRole::Data, TextureRole::Data,  TextureRole::Data};
static_assert(kLookTextures == shared::kTextureSlots);

/// kHas... and kIs... bits of a mesh with its material, without those of lights and surroundings. Textures
/// with a broken image count as absent, except the base colour, which is drawn grey.
[[nodiscard]] uint32_t drawFeatures(const Scene& scene, const Mesh& mesh, const Material& material);

/// Without uvLinear and uvOffset.
[[nodiscard]] shared::MaterialUniforms materialUniforms(const Material& material);

} // namespace touchstone
