#pragma once
// Tests with a short form in the suite and a long one as a sweep: the same claim with the same bounds.

#include <cstdlib>

namespace touchstone::test {

/// How often a test repeats: `usual` in the suite, `sweep` where TOUCHSTONE_SWEEP is set (`ctest -L sweep`).
inline int repetitions(int usual, int sweep) {
    return std::getenv("TOUCHSTONE_SWEEP") == nullptr ? usual : sweep;
}

} // namespace touchstone::test
