#pragma once
// One table over all hard cases of a run of the test program, printed at its end.

#include "tests/stability/hard_case.h"

#include <string>

namespace touchstone::test {

/// Adds a run to the row (name, variant). Each cell keeps the run that came nearest to its allowance.
void addToCaseTable(const std::string& name, const std::string& variant, const Figures& figures);

} // namespace touchstone::test
