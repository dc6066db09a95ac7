#pragma once
// The error of a felt path against the truth.

#include "study/result/result.h"
#include "study/truth/truth_path.h"

namespace touchstone::study {

/// `hips`, `truth` and `ours` have one entry per tick. Ticks where the truth failed are not compared. Energy
/// is the work of each tick's force, held until the next tick as by the servo.
[[nodiscard]] Errors compareWithTruth(std::span<const glm::dvec3> hips,
                                      std::span<const truth::FeltTick> truth,
                                      std::span<const truth::FeltTick> ours);

} // namespace touchstone::study
