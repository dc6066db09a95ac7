#pragma once
// When frames begin. Pure arithmetic.

namespace touchstone {

/// Frames begin on a grid of deadlines, not a period after the one before, where every delay would be lost
/// for good. A frame that is late begins at once and the next one is due on the grid again, so that a short
/// frame makes up for a long one; deadlines that have passed altogether are skipped, so that no burst of
/// frames follows a halt. Times are s of any clock that only rises.
class FramePace {
  public:
    /// `period`: s, > 0.
    explicit FramePace(double period) : period_(period) {}

    /// A frame begins.
    void begin(double now);
    /// When the one after it is to begin: at most a period after `begin`; may have passed already.
    [[nodiscard]] double due() const { return due_; }
    /// Frames in a second, over about the last second; 0 before the second frame.
    [[nodiscard]] double rate() const { return rate_; }

  private:
    double period_;
    double due_ = 0.0;
    double begun_ = 0.0;
    double rate_ = 0.0;
    bool first_ = true;
};

} // namespace touchstone
