#pragma once

#include "haptics/servo/servo_loop.h"
#include "haptics/tick/haptic_step.h"
#include "workbench/timeline/background_job.h"
#include "workbench/timeline/recorded_scenes.h"
#include "workbench/timeline/timeline.h"

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace touchstone {

/// The ticks of a TimelineSegment, and what came of them when they were touched again: a recording keeps
/// inputs, place and force, and the rest (planes, stiction point, normal, energy) is made anew from the
/// checkpoint before.
struct LensSegment {
    size_t number = 0, first = 0;
    std::vector<RecordedTick> ticks;
    std::vector<HapticOutput> outputs; ///< as many, or none
    std::vector<uint8_t> equal;        ///< 1: touched again, and equal to the last bit in every stage
    bool tried = false;                ///< with the scenes that its ticks name
};

/// Reads what lies around the cursor on a worker, a segment (a second, as a rule) at a time, and touches it
/// again where its model is there. Main thread.
class ReplayCache {
  public:
    ReplayCache(std::shared_ptr<const Timeline> timeline, std::shared_ptr<RecordedSceneShelf> shelf)
        : timeline_(std::move(timeline)), shelf_(std::move(shelf)) {}

    /// Once a frame. Throws what stopped the reading (the file has changed under it), once for a segment,
    /// which is not read again; the others are.
    void look(size_t cursor);

    /// What is known of the tick; false while it is being read: then `record` stays what it was.
    bool show(size_t index, TickRecord& record) const;
    /// It was touched again, and came out as it was recorded.
    [[nodiscard]] bool complete(size_t index) const;
    /// Why its ticks cannot be touched again; empty: they can, or nobody has tried.
    [[nodiscard]] const std::string& problem() const { return problem_; }

    /// Nothing is being worked on: it may go without keeping anybody waiting.
    [[nodiscard]] bool finished() const { return sceneJob_.finished() && segmentJob_.finished(); }

  private:
    static constexpr size_t kKept = 4; // segments

    [[nodiscard]] const LensSegment* segmentWith(size_t index) const;
    [[nodiscard]] bool wants(size_t segment) const;
    void read(size_t segment);
    void loadSceneOf(size_t cursor);

    std::shared_ptr<const Timeline> timeline_;
    std::shared_ptr<RecordedSceneShelf> shelf_;
    std::vector<std::shared_ptr<const LensSegment>> kept_; // the newest last
    std::map<uint32_t, FoundScene> scenes_;
    std::set<uint32_t> failed_; // scenes that cannot be loaded
    std::set<size_t> failedSegments_;
    size_t readingSegment_ = 0;
    std::string problem_;
    uint32_t loadingScene_ = 0;
    BackgroundJob<FoundScene> sceneJob_;
    BackgroundJob<std::shared_ptr<const LensSegment>> segmentJob_;
};

} // namespace touchstone
