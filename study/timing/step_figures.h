#pragma once
// From the ticks that were timed to the figures of a step and its stages.

#include "study/result/result.h"
#include "study/timing/configurations.h"

namespace touchstone::study {

/// ns, the clock's cost taken off. The stages are differences between the means up to the end of each, so
/// that they add up to the mean of a whole step as measured with one reading at its end: nothing is left
/// over. All means leave out the slowest 1 % of their ticks: on a machine that does other things those are
/// ticks from which the processor was taken away.
struct StepFigures {
    Estimate median, mean; ///< intervals with what lies between runs
    std::array<Estimate, kStageCount> stages;
};

/// `clock`: what reading it twice takes, ns. Rounds without enough ticks in contact are left out; zeros where
/// all are.
[[nodiscard]] StepFigures figuresOf(std::span<const RoundTimes> rounds, double clock);

} // namespace touchstone::study
