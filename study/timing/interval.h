#pragma once
// How sure a figure is that was measured in rounds.

#include "study/result/result.h"

#include <span>

namespace touchstone::study {

/// Median and mean of the rounds' figures with their 95 % intervals by bootstrap: rounds drawn anew with
/// repetition, 2000 times, and the middle 95 % of what their median (mean) then is. Rounds are the unit,
/// since ticks of one round share whatever else the machine did in it. Deterministic. Zeros for no rounds.
[[nodiscard]] Estimate medianOf(std::span<const double> rounds);
[[nodiscard]] Estimate meanOf(std::span<const double> rounds);

/// Two runs of one build put code and data elsewhere in memory and meet another mood of the machine, which no
/// round of either can know: in eight runs of 48 configurations on each of two scenes, on a busy machine,
/// medians of the bootstrap alone changed places in 400 of 109,000 pairs that it held apart; 5 % more to
/// either side, in none.
inline constexpr double kBetweenRuns = 0.05;

/// The interval with what lies between runs: for what is compared with another run.
[[nodiscard]] inline Estimate acrossRuns(const Estimate& e) {
    return {e.value, (1.0 - kBetweenRuns) * e.low, (1.0 + kBetweenRuns) * e.high};
}

/// The 95 % intervals have no value in common.
[[nodiscard]] inline bool apart(const Estimate& a, const Estimate& b) {
    return a.high < b.low || b.high < a.low;
}

} // namespace touchstone::study
