#pragma once
// How sure a figure is that was measured in rounds.

#include "study/result.h"

#include <span>

namespace touchstone::study {

/// Median and mean of the rounds' figures with their 95 % intervals by bootstrap: rounds drawn anew with
/// repetition, 2000 times, and the middle 95 % of what their median (mean) then is. Rounds are the unit,
/// since ticks of one round share whatever else the machine did in it. Deterministic. Zeros for no rounds.
[[nodiscard]] Estimate medianOf(std::span<const double> rounds);
[[nodiscard]] Estimate meanOf(std::span<const double> rounds);

/// The 95 % intervals have no value in common.
[[nodiscard]] inline bool apart(const Estimate& a, const Estimate& b) {
    return a.high < b.low || b.high < a.low;
}

} // namespace touchstone::study
