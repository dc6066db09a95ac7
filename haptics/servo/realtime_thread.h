#pragma once
// Real-time properties that Linux can grant a thread.

#include <string>

namespace touchstone {

/// The properties granted to the servo thread, for the report.
struct ServoScheduling {
    std::string policy; ///< "SCHED_FIFO 80", "EEVDF slice 100 us", "normal", with what was denied
    bool memoryLocked = false;
    int pinnedCpu = -1; ///< -1: not pinned
};

/// Requests all real-time properties for the calling thread, best first, and returns those granted:
/// SCHED_FIFO, else a short EEVDF slice; locked memory; one CPU if the process has more than one; timer slack
/// of 1 ns; its stack touched. May allocate and block: call it before the first tick. Never fails: a denied
/// property is missing from the report.
[[nodiscard]] ServoScheduling enterRealtime();

/// Sleeps until CLOCK_MONOTONIC reads `deadlineNs`; returns at once if it already does.
void sleepUntil(long long deadlineNs) noexcept;

/// CLOCK_MONOTONIC now, ns.
[[nodiscard]] long long monotonicNs() noexcept;

} // namespace touchstone
