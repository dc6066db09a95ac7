#include "engine/core/huge_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace touchstone {

void wantHugePages(void* data, size_t bytes) noexcept {
    constexpr size_t kSmallest = size_t{4} << 20;
    if (bytes < kSmallest)
        return;
    const auto page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = (reinterpret_cast<uintptr_t>(data) + page - 1) / page * page,
               end = (reinterpret_cast<uintptr_t>(data) + bytes) / page * page;
    (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

} // namespace touchstone
