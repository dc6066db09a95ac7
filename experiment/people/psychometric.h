#pragma once
// A simulated person whose psychometric function is known, to judge a procedure before people's time is
// spent.

#include "experiment/procedure/staircase.h"

#include <cstdint>

namespace touchstone::experiment {

/// Share of right answers in two-interval forced choice: 1/2 + (1/2 - lapses) Phi((middle - level) / spread),
/// Phi the cumulative normal distribution. Levels, `middle` and `spread` have one unit.
struct PsychometricFunction {
    double middle = 0.0;
    double spread = 1.0; ///< standard deviation
    double lapses = 0.0; ///< share of wrong answers that no level mends

    [[nodiscard]] double share(double level) const noexcept;
    /// The level at which a share in (1/2, 1 - lapses) of answers is right, by bisection to rounding.
    [[nodiscard]] double levelOf(double rightShare) const noexcept;
};

/// What a procedure measures of a function.
struct ProcedureError {
    double target = 0.0; ///< the level of the share to which the procedure converges
    double bias = 0.0;   ///< mean threshold - target
    double spread = 0.0; ///< standard deviation of the threshold
    double trials = 0.0; ///< mean
    size_t ended = 0;    ///< runs that came to their end
    size_t runs = 0;
};

/// Runs the staircase `runs` times on answers drawn from the function. The same seed gives the same result.
/// Throws Error where the function's spread is not positive or its lapses lie beyond 0 to 0.25.
[[nodiscard]] ProcedureError simulate(const StaircaseRule& rule, const PsychometricFunction& function,
                                      size_t runs, uint64_t seed);

} // namespace touchstone::experiment
