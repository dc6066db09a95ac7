#pragma once
// Marks the code inside a tick, so that a program can count operations forbidden there.

#include <atomic>
#include <cstdint>

namespace touchstone {

/// Forbidden operations of this process's real-time code. Any thread may read.
struct RealtimeViolations {
    uint64_t allocations = 0;   ///< malloc, operator new and related calls inside a tick
    uint64_t deallocations = 0; ///< free, operator delete inside a tick
    uint64_t locks = 0;         ///< mutexes and read-write locks requested inside a tick
};

namespace realtime {

/// True on a thread that is inside a tick. Costs one store to enter and one to leave.
extern constinit thread_local bool inTick;

/// Called by an interposed allocator (workbench/guards/allocation_guard.cpp) for every call on any thread.
void noteAllocation() noexcept;
void noteDeallocation() noexcept;
/// The same for locks (workbench/guards/lock_guard.cpp).
void noteLock() noexcept;

/// Whether an interposed allocator is linked into this program; without one nothing is counted.
void announceInterposer() noexcept;
[[nodiscard]] bool allocationsAreCounted() noexcept;
void announceLockInterposer() noexcept;
[[nodiscard]] bool locksAreCounted() noexcept;

[[nodiscard]] RealtimeViolations violations() noexcept;
void resetViolations() noexcept;

/// Everything within this scope must not allocate, lock or throw.
class TickScope {
  public:
    // The fences bind the compiler only: it knows that malloc reads no variable of ours, and would move the
    // stores across it.
    TickScope() noexcept {
        inTick = true;
        std::atomic_signal_fence(std::memory_order_seq_cst);
    }
    ~TickScope() {
        std::atomic_signal_fence(std::memory_order_seq_cst);
        inTick = false;
    }
    TickScope(const TickScope&) = delete;
    TickScope& operator=(const TickScope&) = delete;
};

} // namespace realtime
} // namespace touchstone
