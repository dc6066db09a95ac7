#pragma once
// Divides work into steps of about the same time. Pure arithmetic.

#include <algorithm>

namespace touchstone {

/// How much work a step may do, in units whose cost is learnt from the steps done. It at most doubles from
/// step to step and halves after a step that took too long.
class StepSize {
  public:
    static constexpr double kFirst = 30'000.0, kLeast = 2'000.0, kMost = 4'000'000.0; ///< units

    /// `budget`: s, > 0, of one step.
    explicit StepSize(double budget) : budget_(budget) {}

    [[nodiscard]] double work() const { return work_; }
    /// A step of `work` units took `seconds`; other times than positive ones say nothing.
    void done(double seconds, double work) {
        // Nor does a last step that had little left to do, unless it took too long.
        if (!(seconds > 0.0) || (work < 0.5 * work_ && seconds <= budget_))
            return;
        work_ = std::clamp(work_ * std::clamp(budget_ / seconds, 0.5, 2.0), kLeast, kMost);
    }

  private:
    double budget_;
    double work_ = kFirst;
};

} // namespace touchstone
