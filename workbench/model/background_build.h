#pragma once

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <future>
#include <memory>

namespace touchstone {

/// What contact=neighbourhood walks on, what contact=rays casts into and the slopes of
/// textureGradient=precomputed, built on a worker when they are first asked for. Until they are there the
/// servo sweeps, or works the slopes out. Main thread.
class BackgroundBuild {
  public:
    /// In every frame: begins what `settings` ask of `scene` and is not there. Throws what stopped the last
    /// one, once.
    void update(const std::shared_ptr<const HapticScene>& scene, const HapticSettings& settings);

  private:
    std::future<void> building_;
};

} // namespace touchstone
