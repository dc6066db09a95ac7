#pragma once
// Differences that people just notice, beside which an error is small or large.

#include "study/result/result.h"

namespace touchstone::study {

/// Each with its source; those that are only read of at second hand say so.
[[nodiscard]] std::vector<JustNoticeable> noticeableDifferences();

} // namespace touchstone::study
