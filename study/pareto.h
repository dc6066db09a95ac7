#pragma once

#include "study/result.h"

#include <span>

namespace touchstone::study {

/// Marks the rungs that no other one of the same scene, path and ladder is both as cheap as and as near the
/// truth as, and better in one of the two: cost is the median of the step, nearness `felt(errors)`. Rungs of
/// different ladders have different things switched off. Those without ticks to compare are not marked.
void markPareto(std::span<RungResult> rungs);

} // namespace touchstone::study
