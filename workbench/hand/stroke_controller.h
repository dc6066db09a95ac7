#pragma once

#include "devices/stroke/stroke_library.h"

#include <future>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

/// Lays the simulated hand's stroke onto the model that is shown, on a worker: around the point touched last
/// when it is chosen. Main thread.
class StrokeController {
  public:
    /// Another model, in its rest pose: what was touched is forgotten. `tour`: the stroke that came with it;
    /// null: there is nothing to touch.
    void show(ScenePtr scene, const Similarity& workspaceFromScene, std::shared_ptr<const StrokePath> tour);
    /// What is touched now, workspace, where it is in the rest pose.
    void touched(const StrokePlace& place) { touched_ = place; }

    /// In every frame. `wanted`: name, speed and depth; `front`: towards the viewer, workspace. `strokes`:
    /// the simulated hand is chosen. What has been laid anew, once; else null.
    [[nodiscard]] std::shared_ptr<const StrokePath> update(const StrokeRequest& wanted,
                                                           const glm::dvec3& front, bool strokes);
    /// That it is being laid, or why it could not be; empty: nothing to tell.
    [[nodiscard]] std::string notice() const;

  private:
    ScenePtr scene_;
    Similarity workspaceFromScene_;
    std::shared_ptr<const StrokePath> tour_;
    std::optional<StrokePlace> touched_;
    std::optional<StrokeRequest> laid_; ///< what was asked of the worker last; place and front as they were
    bool stroked_ = false;              ///< the simulated hand was chosen in the frame before
    bool chosen_ = false;               ///< it has been chosen since a stroke was last thought of
    uint64_t model_ = 0, laying_ = 0;   ///< numbers of the model shown, and of that the worker has
    std::future<std::shared_ptr<const StrokePath>> worker_;
    std::string problem_;
};

} // namespace touchstone
