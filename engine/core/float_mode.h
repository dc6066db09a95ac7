#pragma once

#include <immintrin.h>

namespace touchstone {

/// Sets flush-to-zero and denormals-are-zero on the calling thread permanently. Every thread that runs ticks
/// calls it at entry: a denormal costs a hundred cycles, Embree expects the mode, and offline and live runs
/// must round alike.
inline void enterFloatMode() noexcept {
    constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
    _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
}

} // namespace touchstone
