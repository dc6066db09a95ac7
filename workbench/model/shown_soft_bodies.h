#pragma once

#include "haptics/world/soft_states.h"
#include "renderer/scene_renderer.h"

#include <cstdint>

namespace touchstone {

/// Soft bodies in the picture. Main thread.
class ShownSoftBodies {
  public:
    /// Their vertices where they are now. `soft` is that of `haptic`, made of `scene`. Takes no time while
    /// all of them sleep.
    void show(SoftStates& soft, const Scene& scene, const HapticScene& haptic, SceneRenderer& renderer);

  private:
    uint64_t sceneNumber_ = 0; ///< SceneRenderer's that has them
};

} // namespace touchstone
