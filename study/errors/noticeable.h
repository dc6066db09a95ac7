#pragma once
// Just-noticeable differences, the scale of the errors.

#include "study/result/result.h"

namespace touchstone::study {

/// Each with its source; second-hand citations are marked as such.
[[nodiscard]] std::vector<JustNoticeable> noticeableDifferences();

} // namespace touchstone::study
