#pragma once

#include "haptics/contact/candidates.h"

namespace touchstone {

/// Time of impact, at most `limit`: the fraction of `move` for which a sphere of radius `reach` around p + t
/// * move is free of every candidate. Conservative: the place where it ends is free, too. At most 40 steps a
/// candidate.
[[nodiscard]] double timeOfImpact(CandidateCache& cache, const glm::dvec3& p, const glm::dvec3& move,
                                  double reach, double limit) noexcept;

} // namespace touchstone
