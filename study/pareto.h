#pragma once

#include "study/result/result.h"

#include <span>

namespace touchstone::study {

/// Nearer the truth without being more expensive, or cheaper without being farther; costs differ if their
/// intervals do not overlap.
[[nodiscard]] bool beats(const Estimate& cost, double error, const Estimate& otherCost, double otherError);

/// Marks the configurations that no other one of the same scene, path and ablation beats: none is nearer the
/// truth, by `felt(errors)`, without being more expensive, or cheaper without being farther. Costs are
/// medians of the step and differ where their intervals do not overlap, so that a second run finds the same
/// front. Configurations of different ablations are not compared, since they disable different stages. Those
/// without compared ticks are not marked.
void markPareto(std::span<ConfigurationResult> configurations);

} // namespace touchstone::study
