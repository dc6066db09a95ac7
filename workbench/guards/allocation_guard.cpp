// Counts allocations and deallocations inside a tick, of which there must be none. Interposes malloc and
// related functions for the whole program, including operator new and libraries, and forwards to glibc. Costs
// one thread-local test per call. Under a sanitizer, which owns the allocator, uses its hooks instead.

#include "engine/core/realtime_guard.h"

#include <cerrno>
#include <cstddef>

namespace {

struct Announce {
    Announce() { touchstone::realtime::announceInterposer(); }
} const announce;

} // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, size_t),
                                                         void (*)(const volatile void*));
namespace {
[[gnu::constructor]] void installHooks() {
    __sanitizer_install_malloc_and_free_hooks(
        [](const volatile void*, size_t) { touchstone::realtime::noteAllocation(); },
        [](const volatile void*) { touchstone::realtime::noteDeallocation(); });
}
} // namespace

#else

extern "C" {

void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* memory);

void* malloc(size_t size) {
    touchstone::realtime::noteAllocation();
    return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
    touchstone::realtime::noteAllocation();
    return __libc_calloc(count, size);
}

void* realloc(void* memory, size_t size) {
    touchstone::realtime::noteAllocation();
    return __libc_realloc(memory, size);
}

void free(void* memory) {
    if (memory != nullptr)
        touchstone::realtime::noteDeallocation();
    __libc_free(memory);
}

void* memalign(size_t alignment, size_t size) {
    touchstone::realtime::noteAllocation();
    return __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
    return memalign(alignment, size);
}

int posix_memalign(void** memory, size_t alignment, size_t size) {
    const bool powerOfTwo = alignment != 0 && (alignment & (alignment - 1)) == 0;
    if (!powerOfTwo || alignment % sizeof(void*) != 0)
        return EINVAL;
    void* got = memalign(alignment, size);
    if (got == nullptr)
        return ENOMEM;
    *memory = got;
    return 0;
}

} // extern "C"

#endif
