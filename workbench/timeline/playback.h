#pragma once

#include "workbench/timeline/timeline.h"

#include <array>
#include <memory>
#include <optional>

namespace touchstone {

/// Cursor and playback of a recording: the cursor is always a tick. Main thread.
class Playback {
  public:
    static constexpr std::array<double, 7> kSpeeds{0.1, 0.25, 0.5, 1.0,
                                                   2.0, 3.0,  4.0}; ///< playback speed relative to real time
    static constexpr double kLongestPause =
        0.25; ///< s; a gap without ticks up to this long is a pause, a longer one is skipped

    explicit Playback(std::shared_ptr<const Timeline> timeline) : timeline_(std::move(timeline)) {}

    [[nodiscard]] size_t cursor() const { return cursor_; } ///< tick
    [[nodiscard]] double seconds() const { return timeline_->seconds(cursor_); }

    void seek(double seconds); ///< to the tick at that time, within the recording
    void step(long ticks);
    void stepSeconds(double seconds); ///< by at least one tick
    void toBegin() { moveTo(0); }
    void toEnd() { moveTo(timeline_->size() - 1); }

    /// At the end, restarts from the beginning.
    void play(bool playing);
    [[nodiscard]] bool playing() const { return playing_; }
    void setSpeed(double speed) { speed_ = speed; }
    [[nodiscard]] double speed() const { return speed_; }

    /// Marks the cursor; clears the other mark if it would be on the wrong side.
    void markBegin();
    void markEnd();
    void clearMarks() { begin_.reset(), end_.reset(); }
    [[nodiscard]] std::optional<size_t> beginMark() const { return begin_; }
    [[nodiscard]] std::optional<size_t> endMark() const { return end_; }
    /// Both marks are set: playback loops between them.
    [[nodiscard]] bool loops() const { return begin_ && end_ && *begin_ < *end_; }
    /// First and last tick of the played range.
    [[nodiscard]] size_t first() const { return begin_.value_or(0); }
    [[nodiscard]] size_t last() const { return end_.value_or(timeline_->size() - 1); }

    /// Advances by `seconds` of wall-clock time.
    void advance(double seconds);

  private:
    void moveTo(size_t index);

    std::shared_ptr<const Timeline> timeline_;
    size_t cursor_ = 0;
    double position_ = 0.0; // s; the cursor is the last tick at or before it
    std::optional<size_t> begin_, end_;
    bool playing_ = false;
    double speed_ = 1.0;
};

} // namespace touchstone
