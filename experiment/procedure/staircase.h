#pragma once
// The adaptive procedure of [004 §5]: one up, two down (H. Levitt, Transformed up-down methods in
// psychoacoustics, 1971), for two-interval forced choice.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace touchstone::experiment {

/// Levels are what the caller varies, segments for [004]: a higher one is harder to tell from the reference.
struct StaircaseRule {
    double start = 0.0;
    double largeStep = 1.0; ///< until `largeReversals` reversals, then `smallStep`
    double smallStep = 1.0;
    double lowest = 0.0, highest = 0.0; ///< a level never leaves them
    size_t largeReversals = 3;
    size_t reversals = 11;   ///< ends the procedure
    size_t averaged = 6;     ///< of the last reversals: the threshold is the mean of their levels
    size_t mostTrials = 400; ///< ends it, too: answers at random never come to an end otherwise
};

/// One condition of one person. A level rises after two right answers in a row and falls after each wrong
/// one; a reversal is an answer that turns the direction, at its level.
class Staircase {
  public:
    struct Trial {
        double level = 0.0;
        bool right = false;
        bool reversal = false;
    };

    /// Throws Error, with a remedy, where a number is not finite, a step is not positive, the start lies
    /// outside of the levels, or more reversals are averaged than counted.
    explicit Staircase(const StaircaseRule& rule);

    /// To be shown next; not after the end.
    [[nodiscard]] double level() const noexcept { return level_; }
    /// Answers the trial at level(). Does nothing after the end.
    void answer(bool right);

    [[nodiscard]] bool finished() const noexcept {
        return reversals_.size() >= rule_.reversals || trials_.size() >= rule_.mostTrials;
    }
    /// Mean level of the last reversals; none before all have been seen.
    [[nodiscard]] std::optional<double> threshold() const noexcept;
    [[nodiscard]] std::span<const Trial> trials() const noexcept { return trials_; }
    [[nodiscard]] std::span<const double> reversals() const noexcept { return reversals_; }

  private:
    enum class Direction { None, Up, Down };

    StaircaseRule rule_;
    double level_;
    std::vector<Trial> trials_;
    std::vector<double> reversals_;
    size_t rightInARow_ = 0;
    Direction direction_ = Direction::None;
};

/// Share of right answers to which one up, two down converges: p^2 = 1/2.
inline constexpr double kStaircaseShare = 0.70710678118654752;

} // namespace touchstone::experiment
