#pragma once
// The part of the open model that is felt, compiled on a worker.

#include "devices/stroke/stroke_path.h"
#include "haptics/servo/servo_loop.h"
#include "workbench/model/model.h"

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <utility>

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

/// Makes the parts that are asked for, one at a time, and knows how each is taken up. Main thread; only the
/// destructor waits for the worker.
class FeltPartBuild {
  public:
    using Maker = std::function<FeltPart(const Model&, const ScenePart&)>;
    explicit FeltPartBuild(Maker make = feltPart) : make_(std::move(make)) {}

    /// Another model, or geometry, is felt as a whole, of which parts are made from now on: one that is being
    /// made is dropped.
    void wholeIsFelt();
    /// What is felt has other geometry than what parts are made of from now on.
    void geometryChanged() { toWhole_ = toPart_ = SceneSwap::Anew; }
    /// Every frame in which a part is missing. False: the last one is not done, or what is asked for is what
    /// failed last. `whole` is a whole model.
    [[nodiscard]] bool start(const Model& whole, const ScenePart& part);
    /// The finished part; throws the worker's error once.
    [[nodiscard]] std::optional<FeltPart> take();
    /// From what is felt to the part that was taken last, if that shows no more.
    [[nodiscard]] SceneSwap swap() const { return toPart_; }

  private:
    struct Asked {
        std::shared_ptr<const HapticScene> whole;
        ScenePart part;
        bool operator==(const Asked&) const = default;
    };

    Maker make_;
    std::future<FeltPart> job_;
    bool dropped_ = false; // what the job makes
    Asked asked_;
    std::optional<Asked> failed_;
    // From what is felt to a part that is started now, and to the one that is being made:
    SceneSwap toWhole_ = SceneSwap::SameGeometry, toPart_ = SceneSwap::SameGeometry;
};

} // namespace touchstone
