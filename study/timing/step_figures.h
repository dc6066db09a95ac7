#pragma once
// Figures of a step and its stages from the timed ticks.

#include "study/result/result.h"
#include "study/timing/configurations.h"

namespace touchstone::study {

/// ns, clock overhead subtracted. The stages are differences between the means up to the end of each, so they
/// add up to the mean of a whole step with one reading at its end. All means leave out the slowest 1 % of
/// their ticks: on a machine with other load, those lost the processor.
struct StepFigures {
    Estimate median, mean; ///< intervals with the variation between runs
    std::array<Estimate, kStageCount> stages;
};

/// `clock`: time of two readings, ns. Rounds with too few contact ticks are left out; zeros where all are.
[[nodiscard]] StepFigures figuresOf(std::span<const RoundTimes> rounds, double clock);

} // namespace touchstone::study
