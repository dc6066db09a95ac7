#pragma once
// Upper tails of the distributions that an analysis of variance needs. Any thread.

namespace touchstone::experiment {

/// P(F > f) with `between` and `within` degrees of freedom (Boost.Math). Throws Error for degrees that are
/// not positive. 1 for f <= 0, NaN for NaN.
[[nodiscard]] double fTail(double f, double between, double within);
/// The t of a two-sided interval of `confidence` (0.95) with `degrees` of freedom.
[[nodiscard]] double tQuantile(double confidence, double degrees);
/// P(Q > q) of the studentized range of `groups` means with `degrees` of freedom of the error:
/// the integral over the error's scale s of the range of `groups` normal variables beyond q s (Harter 1960),
/// by Gauss-Kronrod quadrature; to 1e-8. Throws Error for fewer than two groups or one degree.
[[nodiscard]] double studentizedRangeTail(double q, int groups, double degrees);
/// The q of which studentizedRangeTail is `tail`, in (0, 1).
[[nodiscard]] double studentizedRangeQuantile(double tail, int groups, double degrees);
/// P(X >= right) of `trials` guesses at 1/2: whether somebody can tell.
[[nodiscard]] double guessTail(int right, int trials);

} // namespace touchstone::experiment
