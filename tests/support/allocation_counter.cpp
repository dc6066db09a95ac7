#include "tests/support/allocation_counter.h"

#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

thread_local uint64_t allocations = 0;
std::atomic<int64_t> held{0}, start{0}, peak{0}; // bytes

void hold(void* memory) noexcept {
    if (memory == nullptr)
        return;
    const auto size = static_cast<int64_t>(::malloc_usable_size(memory));
    const int64_t now = held.fetch_add(size, std::memory_order_relaxed) + size;
    int64_t most = peak.load(std::memory_order_relaxed);
    while (now > most && !peak.compare_exchange_weak(most, now, std::memory_order_relaxed)) {
    }
}

void release(void* memory) noexcept {
    if (memory == nullptr)
        return;
    held.fetch_sub(static_cast<int64_t>(::malloc_usable_size(memory)), std::memory_order_relaxed);
    std::free(memory);
}

void* counted(std::size_t size, std::size_t alignment) {
    ++allocations;
    if (size == 0)
        size = 1;
    void* memory = alignment <= alignof(std::max_align_t)
                       ? std::malloc(size)
                       : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (memory == nullptr)
        throw std::bad_alloc();
    hold(memory);
    return memory;
}

} // namespace

uint64_t touchstone::test::allocationsOnThisThread() noexcept {
    return allocations;
}

void touchstone::test::resetPeakBytes() noexcept {
    start = held.load();
    peak = held.load();
}

uint64_t touchstone::test::peakBytes() noexcept {
    return static_cast<uint64_t>(peak - start);
}

// The array forms of the standard library call these. Its nothrow forms would, too, but under
// AddressSanitizer they are the sanitizer's own, whose memory must not come back through our delete.
void* operator new(std::size_t size) {
    return counted(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    void* memory = std::malloc(size == 0 ? 1 : size);
    hold(memory);
    return memory;
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}
