#pragma once
// Memory that is read here and there: with pages of 2 MB the processor finds its addresses in its own tables.

#include <cstddef>
#include <vector>

namespace touchstone {

/// Asks for huge pages for an array that nothing has been written to. A hint: where there are none, nothing
/// changes. Nothing for what is smaller than some of them.
void wantHugePages(void* data, size_t bytes) noexcept;

/// Reserves memory of an empty vector and asks for huge pages for it.
template <class T>
void reserveInHugePages(std::vector<T>& values, size_t count) {
    values.reserve(count);
    wantHugePages(values.data(), count * sizeof(T));
}

} // namespace touchstone
