#pragma once
// Persistent textures as touch has made them, into the picture.

#include "haptics/scene/haptic_scene.h"
#include "haptics/texture/persistent_textures.h"
#include "renderer/scene_renderer.h"

#include <cstdint>
#include <vector>

namespace touchstone {

/// Passes on what has changed since the last call. Main thread.
class ShownTextures {
  public:
    /// `textures`: of the objects of `scene`; null: none, what is shown stays. `scene` has the instances that
    /// the renderer draws.
    void show(const HapticScene& scene, const PersistentTextures* textures, SceneRenderer& renderer);

  private:
    const PersistentTextures* of_ = nullptr;
    uint64_t sceneNumber_ = 0;    ///< SceneRenderer's
    std::vector<uint64_t> shown_; ///< by object: PersistentTexture::revision
};

} // namespace touchstone
