#pragma once

#include "haptics/body/rigid_body.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/tick/haptic_step.h"
#include "workbench/timeline/background_job.h"
#include "workbench/timeline/recorded_scenes.h"
#include "workbench/timeline/timeline.h"

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The ticks of a TimelineSegment, with the outputs of recomputing them. A recording keeps inputs, proxy and
/// force; the rest (planes, stiction point, normal, energy) is recomputed from the previous checkpoint.
struct LensSegment {
    size_t number = 0, first = 0;
    std::vector<RecordedTick> ticks;
    std::vector<HapticOutput> outputs; ///< as many, or none
    std::vector<uint8_t> equal;        ///< 1: recomputed, and bitwise equal in every stage
    /// After each recomputed tick, of a scene with bodies, in the recorded workspace; else empty.
    std::vector<std::vector<body::Pose>> bodies;
    /// The same of the objects that a caller moved.
    std::vector<std::vector<DrivenPose>> moved;
    bool tried = false; ///< with the scenes of its ticks
};

/// Reads the segments around the cursor on a worker, one (usually a second) at a time, and recomputes them
/// where the model is available. Main thread.
class ReplayCache {
  public:
    ReplayCache(std::shared_ptr<const Timeline> timeline, std::shared_ptr<RecordedSceneShelf> shelf)
        : timeline_(std::move(timeline)), shelf_(std::move(shelf)) {}

    /// Every frame. Throws a read error (the file changed) once per segment, which is not read again; the
    /// others are.
    void look(size_t cursor);

    /// The data of a tick; false while it is being read: then `record` is unchanged.
    bool show(size_t index, TickRecord& record) const;
    /// The bodies after a tick that was recomputed, in the recorded workspace; null: it was not, or has none.
    [[nodiscard]] const std::vector<body::Pose>* bodies(size_t index) const;
    /// The same of the objects that a caller moved; empty: there are none.
    [[nodiscard]] std::span<const DrivenPose> moved(size_t index) const;
    /// It was recomputed, with the recorded result.
    [[nodiscard]] bool complete(size_t index) const;
    /// Why its ticks cannot be recomputed; empty: no problem, or not tried.
    [[nodiscard]] const std::string& problem() const { return problem_; }

    /// No work in progress: destruction does not wait.
    [[nodiscard]] bool finished() const { return sceneJob_.finished() && segmentJob_.finished(); }

  private:
    static constexpr size_t kKept = 4; // segments

    [[nodiscard]] const LensSegment* segmentWith(size_t index) const;
    [[nodiscard]] bool wants(size_t segment) const;
    void read(size_t segment);
    void loadSceneOf(size_t cursor);

    std::shared_ptr<const Timeline> timeline_;
    std::shared_ptr<RecordedSceneShelf> shelf_;
    std::vector<std::shared_ptr<const LensSegment>> kept_; // the most recent last
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
