#include "experiment/people/psychometric.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::experiment {

double PsychometricFunction::share(double level) const noexcept {
    const double normal = 0.5 * std::erfc((level - middle) / (spread * std::sqrt(2.0)));
    return 0.5 + (0.5 - lapses) * normal;
}

double PsychometricFunction::levelOf(double rightShare) const noexcept {
    constexpr double kFar = 10.0; // spreads: beyond them a double knows no tail
    double low = middle - kFar * spread, high = middle + kFar * spread;
    for (int i = 0; i < 100; ++i) {
        const double half = 0.5 * (low + high);
        (share(half) > rightShare ? low : high) = half;
    }
    return 0.5 * (low + high);
}

ProcedureError simulate(const StaircaseRule& rule, const PsychometricFunction& function, size_t runs,
                        uint64_t seed) {
    constexpr double kMostLapses = 0.25; // beyond 0.29 no level has kStaircaseShare of right answers
    if (!std::isfinite(function.middle) || !(function.spread > 0.0) || !std::isfinite(function.spread) ||
        !(function.lapses >= 0.0 && function.lapses <= kMostLapses))
        throw Error("psychometric function", "",
                    "its spread is not positive, or its lapses lie beyond 0 to 0.25",
                    "give the spread in the unit of the levels and lapses as a share of the answers");
    std::mt19937_64 random(seed);
    ProcedureError error{.target = function.levelOf(kStaircaseShare), .runs = runs};
    double sum = 0.0, squares = 0.0, trials = 0.0;
    for (size_t run = 0; run < runs; ++run) {
        Staircase staircase(rule);
        while (!staircase.finished()) {
            // 53 bits of the generator: the standard's distributions differ between libraries.
            const double drawn = static_cast<double>(random() >> 11) * 0x1p-53;
            staircase.answer(drawn < function.share(staircase.level()));
        }
        trials += static_cast<double>(staircase.trials().size());
        if (const auto threshold = staircase.threshold()) {
            ++error.ended;
            sum += *threshold - error.target;
            squares += (*threshold - error.target) * (*threshold - error.target);
        }
    }
    const auto ended = static_cast<double>(error.ended);
    error.bias = error.ended > 0 ? sum / ended : 0.0;
    error.spread = error.ended > 1
                       ? std::sqrt(std::max(0.0, (squares - ended * error.bias * error.bias) / (ended - 1.0)))
                       : 0.0;
    error.trials = runs > 0 ? trials / static_cast<double>(runs) : 0.0;
    return error;
}

} // namespace touchstone::experiment
