#pragma once
// Link touchstone_allocation_counter to replace the global operator new of a test by one that counts.

#include <cstdint>

namespace touchstone::test {

/// Allocations through operator new on the calling thread since it began.
[[nodiscard]] uint64_t allocationsOnThisThread() noexcept;

/// From here on: how many bytes more than now are held at once through operator new, by all threads.
void resetPeakBytes() noexcept;
[[nodiscard]] uint64_t peakBytes() noexcept;

} // namespace touchstone::test
