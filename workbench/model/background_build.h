#pragma once

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <future>
#include <memory>

namespace touchstone {

/// Builds on a worker, at first use: the adjacency for contact=neighbourhood, the ray structure for
/// contact=rays and the slopes for textureGradient=precomputed. Until then the servo sweeps, or computes the
/// slopes per tick. Main thread.
class BackgroundBuild {
  public:
    /// Every frame: starts building what `settings` require of `scene` and is missing. Throws the last error
    /// once.
    void update(const std::shared_ptr<const HapticScene>& scene, const HapticSettings& settings);

  private:
    std::future<void> building_;
};

} // namespace touchstone
