#pragma once
// What touch has made of persistent textures, into the model's file.

#include "engine/import/materials/texture_values.h"
#include "engine/save/material_patch.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/texture/persistent_textures.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace touchstone {

/// By the material's index in the file.
using TexturesToSave = std::map<size_t, std::vector<TextureValues>>;

/// A copy of those that touch has changed, and of those that began as the file says. `source`: what `haptic`
/// was compiled from; `textures` may be null.
[[nodiscard]] TexturesToSave texturesToSave(const Scene& source, const HapticScene& haptic,
                                            const PersistentTextures* textures);

/// The patches with the values (they are compressed here: some 20 ms for a million texels).
[[nodiscard]] MaterialPatches withTextures(MaterialPatches patches, const TexturesToSave& textures);

/// Which textures touch has changed since they were saved. One thread.
class TextureWatch {
  public:
    /// Every frame; others than before count as unchanged until they change. Null: none.
    void look(const PersistentTextures* textures);
    [[nodiscard]] bool changed() const { return now_ != saved_; }
    /// Those that `look` saw last are in the file.
    void saved(uint64_t revision) { saved_ = revision; }
    [[nodiscard]] uint64_t revision() const { return now_; }

  private:
    const PersistentTextures* of_ = nullptr;
    uint64_t now_ = 0, saved_ = 0; ///< sums of PersistentTexture::revision
};

} // namespace touchstone
