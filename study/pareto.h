#pragma once

#include "study/result/result.h"

#include <span>

namespace touchstone::study {

/// Nearer the truth without being dearer, or cheaper without being farther, where costs differ if their
/// intervals have no value in common.
[[nodiscard]] bool beats(const Estimate& cost, double error, const Estimate& otherCost, double otherError);

/// Marks the configurations that no other one of the same scene, path and ablation beats: is nearer the
/// truth, by `felt(errors)`, without being dearer, or is cheaper without being farther. Costs are medians of
/// the step, and they differ where their intervals have no value in common, so that a second run finds the
/// same front. Configurations of different ablations have different things switched off. Those without ticks
/// to compare are not marked.
void markPareto(std::span<ConfigurationResult> configurations);

} // namespace touchstone::study
