#pragma once
// Memory that is read here and there: with pages of 2 MB the processor finds its addresses in its own tables.

#include <cstddef>

namespace touchstone {

/// Asks for huge pages for an array that nothing has been written to. A hint: where there are none, nothing
/// changes. Nothing for what is smaller than some of them.
void wantHugePages(void* data, size_t bytes) noexcept;

} // namespace touchstone
