#include "engine/core/realtime_guard.h"

#include <atomic>

namespace touchstone::realtime {

constinit thread_local bool inTick = false;

namespace {
constinit std::atomic<uint64_t> allocations{0};
constinit std::atomic<uint64_t> deallocations{0};
constinit std::atomic<uint64_t> locks{0};
constinit std::atomic<bool> interposed{false};
constinit std::atomic<bool> lockInterposed{false};
} // namespace

void noteAllocation() noexcept {
    if (inTick)
        allocations.fetch_add(1, std::memory_order_relaxed);
}

void noteDeallocation() noexcept {
    if (inTick)
        deallocations.fetch_add(1, std::memory_order_relaxed);
}

void noteLock() noexcept {
    if (inTick)
        locks.fetch_add(1, std::memory_order_relaxed);
}

void announceLockInterposer() noexcept {
    lockInterposed.store(true, std::memory_order_relaxed);
}

bool locksAreCounted() noexcept {
    return lockInterposed.load(std::memory_order_relaxed);
}

void announceInterposer() noexcept {
    interposed.store(true, std::memory_order_relaxed);
}

bool allocationsAreCounted() noexcept {
    return interposed.load(std::memory_order_relaxed);
}

RealtimeViolations violations() noexcept {
    return {allocations.load(std::memory_order_relaxed), deallocations.load(std::memory_order_relaxed),
            locks.load(std::memory_order_relaxed)};
}

void resetViolations() noexcept {
    allocations.store(0, std::memory_order_relaxed);
    deallocations.store(0, std::memory_order_relaxed);
    locks.store(0, std::memory_order_relaxed);
}

} // namespace touchstone::realtime
