#pragma once
// Materials: appearance, and (gltf_haptics.h) haptic properties.

#include "engine/import/materials/gltf_document.h"
#include "engine/import/materials/gltf_shaders.h"

#include <map>
#include <tuple>
#include <vector>

namespace touchstone {

/// The sources of a placed primitive's material. The haptic extensions bind by mesh and by node, so one glTF
/// material can become several in the scene.
struct SurfaceKey {
    int material = -1; ///< index into the file's materials; < 0: glTF's default material
    int mpeg = -1;     ///< index into MPEG_haptic_material's materials
    int physics = -1;  ///< index into KHR_physics_rigid_bodies' physicsMaterials

    auto operator<=>(const SurfaceKey&) const = default;
};

/// The scene's materials: first the file's own in their order (so that indices in messages agree), then the
/// combinations that the extensions make, then the default material if it is needed.
class MaterialTable {
  public:
    MaterialTable(ImportContext& context, const GltfDocument& document);

    /// The index of the material for this key, created if new.
    [[nodiscard]] int indexOf(const SurfaceKey& key);
    [[nodiscard]] const Material& material(int index) const { return materials_[static_cast<size_t>(index)]; }

    /// Never empty: a file without materials gets the default one.
    [[nodiscard]] std::vector<Material> take();

  private:
    /// The statements of one MPEG material alone.
    [[nodiscard]] const HapticLayers& mpegSays(int index);

    ImportContext& context_;
    const GltfDocument& document_;
    std::vector<Material> materials_;
    std::map<SurfaceKey, int> made_;
    ShaderReader shaders_;
    std::map<int, HapticLayers> mpeg_; ///< by index: read once, with shared JSON
};

/// A textureInfo with its sampler, image and KHR_texture_transform. `info` may be unchecked JSON
/// (extensions).
[[nodiscard]] TextureRef readTexture(ImportContext& context, const GltfDocument& document,
                                     const nlohmann::json& info, const std::string& place);

/// All of the file's textures, by its own indices.
[[nodiscard]] std::vector<SceneTexture> readTextures(ImportContext& context, const GltfDocument& document);

} // namespace touchstone
