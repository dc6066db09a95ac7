#pragma once
// The part of the open model that is felt, compiled on a worker.

#include "devices/stroke/stroke_path.h"
#include "workbench/model/model.h"

#include <future>
#include <memory>
#include <optional>

namespace touchstone {

struct FeltPart {
    ScenePart part;
    std::shared_ptr<const HapticScene> whole, haptic; ///< what it is a part of, and what is felt
    uint64_t feltHash = 0;
    ScenePtr strokes;                       ///< what the simulated hand's strokes are laid on
    std::shared_ptr<const StrokePath> path; ///< its tour; null: nothing to touch
};

/// Any thread but the servo; throws Error.
[[nodiscard]] FeltPart feltPart(const Model& whole, const ScenePart& part);

/// One job at a time. Main thread; only the destructor waits for the worker.
class FeltPartBuild {
  public:
    [[nodiscard]] bool busy() const { return job_.valid(); }
    /// Only while not busy. `whole` is a whole model.
    void start(const Model& whole, const ScenePart& part);
    /// The finished part; throws the worker's error once.
    [[nodiscard]] std::optional<FeltPart> take();

  private:
    std::future<FeltPart> job_;
};

} // namespace touchstone
