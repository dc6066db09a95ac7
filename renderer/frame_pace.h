#pragma once
// Frame scheduling. Pure arithmetic.

namespace touchstone {

/// Frames start on a grid of deadlines, not a period after the previous frame, which would accumulate delays.
/// A late frame starts at once and the next one is due on the grid again, so that a short frame compensates
/// for a long one. Missed deadlines are skipped, so that a stall is not followed by a burst. Times are s of
/// any monotonic clock.
class FramePace {
  public:
    /// `period`: s, > 0.
    explicit FramePace(double period) : period_(period) {}

    /// A frame starts.
    void begin(double now);
    /// Deadline of the next frame: at most a period after `begin`; may be in the past.
    [[nodiscard]] double due() const { return due_; }
    /// Frames per second, over about the last second; 0 before the second frame.
    [[nodiscard]] double rate() const { return rate_; }

  private:
    double period_;
    double due_ = 0.0;
    double begun_ = 0.0;
    double rate_ = 0.0;
    bool first_ = true;
};

} // namespace touchstone
