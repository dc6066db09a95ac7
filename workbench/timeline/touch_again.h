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

/// Sends the recorded hand through the servo once more, with the settings and materials of now, and keeps the
/// force that comes of it beside the recorded one. Main thread.
class TouchAgain {
  public:
    explicit TouchAgain(PlaybackDevice& hand) : hand_(hand) {}

    struct Part {
        size_t first = 0, last = 0; ///< ticks of the recording
        bool repeats = false;
        Similarity deviceFromRecorded{}; ///< where the model that is open is fitted otherwise than it was
        double period = 0.0;             ///< s, of what moves in the scene; 0: nothing does
    };
    /// Reads the part on a worker, then the hand goes. Ends what was touched again before.
    void start(std::shared_ptr<const Timeline> timeline, const Part& part);
    /// Back to the own hand; what was felt stays to be seen.
    void stop();
    /// Forgets what was felt.
    void clear();
    /// Once a frame, with the newest ticks of the servo. Throws what stopped the reading.
    void update(const ForceHistory& live, double servoTime);

    /// The recorded hand touches, is on its way there, or is being read.
    [[nodiscard]] bool running() const { return path_ != nullptr || startWanted_ || reading_.wanted(); }
    /// Where in the recording the hand is, s; nothing while it is on its way.
    [[nodiscard]] std::optional<double> seconds() const { return seconds_; }

    /// N; NaN where nothing has been felt again. For ticks first() and on.
    [[nodiscard]] const std::vector<float>& force() const { return force_; }
    [[nodiscard]] size_t first() const { return part_.first; }

    /// Over the ticks of this round in which both were in contact, or one was.
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
    bool startWanted_ = false; // a reading that nobody wants any more must end first
    std::shared_ptr<const RecordedPath> path_;
    std::vector<float> force_;
    std::optional<size_t> lastFelt_; // of force_, in this round
    std::optional<double> seconds_;
    double seen_ = 0.0; // s, of the servo's ticks
    double recordedSum_ = 0.0, nowSum_ = 0.0;
    size_t compared_ = 0;
};

} // namespace touchstone
