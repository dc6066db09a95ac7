#include "engine/core/realtime_guard.h"

#include <atomic>

namespace touchstone::realtime {

constinit thread_local bool inTick = false;

namespace {
constinit std::atomic<uint64_t> allocations{0};
constinit std::atomic<uint64_t> deallocations{0};
constinit std::atomic<bool> interposed{false};
} // namespace

void noteAllocation() noexcept {
    if (inTick)
        allocations.fetch_add(1, std::memory_order_relaxed);
}

void noteDeallocation() noexcept {
    if (inTick)
        deallocations.fetch_add(1, std::memory_order_relaxed);
}

void announceInterposer() noexcept {
    interposed.store(true, std::memory_order_relaxed);
}

bool allocationsAreCounted() noexcept {
    return interposed.load(std::memory_order_relaxed);
}

RealtimeViolations violations() noexcept {
    return {allocations.load(std::memory_order_relaxed), deallocations.load(std::memory_order_relaxed)};
}

void resetViolations() noexcept {
    allocations.store(0, std::memory_order_relaxed);
    deallocations.store(0, std::memory_order_relaxed);
}

} // namespace touchstone::realtime
