#pragma once
// Link touchstone_allocation_counter to replace the global operator new of a test by one that counts.

#include <cstdint>

namespace touchstone::test {

/// Allocations through operator new on the calling thread since it began.
[[nodiscard]] uint64_t allocationsOnThisThread() noexcept;

} // namespace touchstone::test
