#pragma once

#include "devices/stroke/stroke_library.h"

#include <future>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

/// Lays the simulated hand's stroke onto the current model, on a worker: around the point touched last when
/// the stroke is chosen. Main thread.
class StrokeController {
  public:
    /// Another model, in its rest pose: forgets the touched point. `tour`: the stroke that came with it;
    /// null: there is nothing to touch.
    void show(ScenePtr scene, const Similarity& workspaceFromScene, std::shared_ptr<const StrokePath> tour);
    /// The point touched now, workspace, in the rest pose.
    void touched(const StrokePlace& place) { touched_ = place; }

    /// Every frame. `wanted`: name, speed and depth; `front`: towards the viewer, workspace. `strokes`: the
    /// simulated hand is chosen. Returns a newly laid stroke once; else null.
    [[nodiscard]] std::shared_ptr<const StrokePath> update(const StrokeRequest& wanted,
                                                           const glm::dvec3& front, bool strokes);
    /// "being laid", or the reason for failure; empty: no message.
    [[nodiscard]] std::string notice() const;

  private:
    ScenePtr scene_;
    Similarity workspaceFromScene_;
    std::shared_ptr<const StrokePath> tour_;
    std::optional<StrokePlace> touched_;
    std::optional<StrokeRequest> laid_; ///< last request to the worker, with place and front of that time
    bool stroked_ = false;              ///< the simulated hand was chosen in the previous frame
    bool chosen_ = false;               ///< chosen since the last request
    uint64_t model_ = 0, laying_ = 0;   ///< number of the current model, and of the worker's
    std::future<std::shared_ptr<const StrokePath>> worker_;
    std::string problem_;
};

} // namespace touchstone
