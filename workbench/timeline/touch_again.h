#pragma once

#include "engine/math/similarity.h"
#include "workbench/readings/force_history.h"
#include "workbench/timeline/background_job.h"
#include "workbench/timeline/playback_device.h"
#include "workbench/timeline/timeline.h"

#include <memory>
#include <optional>
#include <vector>

namespace touchstone {

/// Replays the recorded hand through the servo with the current settings and materials, and keeps the
/// resulting force for comparison with the recorded one. Main thread.
class TouchAgain {
  public:
    explicit TouchAgain(PlaybackDevice& hand) : hand_(hand) {}

    struct Part {
        size_t first = 0, last = 0; ///< ticks of the recording
        bool repeats = false;
        Similarity deviceFromRecorded{}; ///< where the open model is fitted differently than in the recording
        double period = 0.0;             ///< s, of the scene's animation; 0: static
    };
    /// Reads the part on a worker, then starts the hand. Ends a running replay.
    void start(std::shared_ptr<const Timeline> timeline, const Part& part);
    /// Back to the live hand; the result stays visible.
    void stop();
    /// Discards the result.
    void clear();
    /// Every frame, with the servo's latest ticks. Throws a read error once.
    void update(const ForceHistory& live, double servoTime);

    /// The recorded hand is in contact, gliding, or being read.
    [[nodiscard]] bool running() const { return path_ != nullptr || startWanted_ || reading_.wanted(); }
    /// Position in the recording, s; nullopt while gliding.
    [[nodiscard]] std::optional<double> seconds() const { return seconds_; }

    /// N; NaN without a result. For ticks from first() on.
    [[nodiscard]] const std::vector<float>& force() const { return force_; }
    [[nodiscard]] size_t first() const { return part_.first; }

    /// Over the ticks of this round in contact in either.
    struct Means {
        double recorded = 0.0, now = 0.0; ///< N
        size_t ticks = 0;
    };
    [[nodiscard]] Means means() const;

  private:
    void feel(double seconds, float force);

    PlaybackDevice& hand_;
    std::shared_ptr<const Timeline> timeline_;
    Part part_;
    BackgroundJob<std::shared_ptr<const RecordedPath>> reading_;
    bool startWanted_ = false; // a cancelled reading must end first
    std::shared_ptr<const RecordedPath> path_;
    std::vector<float> force_;
    std::optional<size_t> lastFelt_; // of force_, in this round
    std::optional<double> seconds_;
    double seen_ = 0.0; // s, of the servo's ticks
    double recordedSum_ = 0.0, nowSum_ = 0.0;
    size_t compared_ = 0;
};

} // namespace touchstone
