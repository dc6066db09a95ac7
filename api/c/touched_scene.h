#pragma once

#include "api/c/handles.h"
#include "devices/stroke/stroke_library.h"
#include "haptics/recording/scene_identity.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace touchstone::api {

/// What a ts_scene names. Immutable but for what is built on demand.
class TouchedScene final : public Object {
  public:
    /// Compiles it. Throws Error.
    TouchedScene(ScenePtr scene, Fit fit);

    [[nodiscard]] const ScenePtr& source() const { return source_; }
    [[nodiscard]] const std::shared_ptr<const HapticScene>& haptic() const { return haptic_; }
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    [[nodiscard]] bool moves() const;
    [[nodiscard]] Bounds bounds() const; ///< at rest, workspace

    /// Builds what the settings need. Any thread.
    void prepareFor(const HapticSettings& settings);
    /// For recordings; reads the file again the first time. Any thread.
    [[nodiscard]] SceneIdentity identity();
    /// Laid once for as long as it is among the newest: callers ask twice, for the number of rows and for the
    /// rows, and several hands follow one. Any thread. Throws Error.
    [[nodiscard]] std::shared_ptr<const StrokePath> stroke(const StrokeRequest& request);

  private:
    ScenePtr source_;
    Fit fit_;
    std::shared_ptr<const HapticScene> haptic_;
    std::vector<std::string> warnings_;
    std::mutex building_, identifying_;
    std::unique_ptr<const SceneIdentity> identity_; // guarded by identifying_
    struct LaidStroke {
        StrokeRequest request;
        std::shared_ptr<const StrokePath> path;
    };
    std::mutex laying_;
    std::deque<LaidStroke> strokes_; // the newest last; guarded by laying_
};

} // namespace touchstone::api
