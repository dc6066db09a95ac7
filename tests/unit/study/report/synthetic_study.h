#pragma once
// Studies that nobody measured: every field with a figure of its own, and one that looks like a measured one.

#include "study/result/result.h"
#include "tests/support/program.h"

namespace touchstone::study::test {

/// One of each, no two figures alike, with figures that print badly.
[[nodiscard]] StudyResult everyField();

/// As a study of two shapes and a servo would look: five ablations, one of them of 24 configurations, an
/// exact configuration, tessellations, rates, what people notice. Names hold what a shell, gnuplot and SVG
/// read something into.
[[nodiscard]] StudyResult likeMeasured();

using touchstone::test::readFile;
using touchstone::test::ScratchFolder;

} // namespace touchstone::study::test
