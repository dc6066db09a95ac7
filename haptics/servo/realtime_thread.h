#pragma once
// What Linux can grant a thread that must wake on time.

#include <string>

namespace touchstone {

/// What the servo was granted, for an honest report.
struct ServoScheduling {
    std::string policy; ///< "SCHED_FIFO 80", "EEVDF slice 100 us", "normal", with what was denied
    bool memoryLocked = false;
    int pinnedCpu = -1; ///< -1: not pinned
};

/// Asks for everything the calling thread can get, best first, and tells what it got: SCHED_FIFO, else a
/// short EEVDF slice; locked memory; one CPU if the process has more than one; timer slack of 1 ns; its stack
/// touched. May allocate and block: call it before the first tick. Never fails: what is denied is not in the
/// report.
[[nodiscard]] ServoScheduling enterRealtime();

/// Sleeps until CLOCK_MONOTONIC reads `deadlineNs`; returns at once if it already does.
void sleepUntil(long long deadlineNs) noexcept;

/// CLOCK_MONOTONIC now, ns.
[[nodiscard]] long long monotonicNs() noexcept;

} // namespace touchstone
