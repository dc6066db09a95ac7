#pragma once
// How far what was felt on a path is from what should have been felt.

#include "study/result/result.h"
#include "study/truth/truth_path.h"

namespace touchstone::study {

/// `hips`, `truth` and `ours` have one entry a tick. Where the truth failed nothing is compared. Energy is
/// the work of each tick's force, held until the next tick as the servo holds it.
[[nodiscard]] Errors compareWithTruth(std::span<const glm::dvec3> hips,
                                      std::span<const truth::FeltTick> truth,
                                      std::span<const truth::FeltTick> ours);

} // namespace touchstone::study
