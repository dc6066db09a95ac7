#pragma once
// Loops over independent blocks on two threads: loading may take two cores, and no more during touch.

#include "engine/core/progress.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

namespace touchstone {

/// Calls work(begin, end) for ranges that cover 0..count, on the calling thread and on another one. No range
/// may read or write what another one writes: then the result is the same with one thread. Reports from the
/// calling thread; throws Cancelled, and exceptions of `work`. Leaves no thread behind.
template <class Work>
void inParallel(size_t count, const Progress& progress, const char* what, const Work& work) {
    progress.step(0.0, what); // also where the other thread takes all blocks
    std::atomic<size_t> next{0};
    std::mutex failing;
    std::exception_ptr failure;
    const auto run = [&](bool reports) noexcept {
        try {
            for (;;) {
                const size_t begin = next.fetch_add(kProgressWork, std::memory_order_relaxed);
                if (begin >= count)
                    return;
                if (reports)
                    progress.step(share(begin, count), what);
                else
                    progress.stopIfCancelled();
                work(begin, begin + std::min(kProgressWork, count - begin));
            }
        } catch (...) {
            next.store(count, std::memory_order_relaxed);
            const std::lock_guard lock(failing);
            failure = failure ? failure : std::current_exception();
        }
    };
    std::thread second;
    if (count > kProgressWork) {
        try {
            second = std::thread(run, false);
        } catch (const std::system_error&) { // no thread available: run alone
        }
    }
    run(true);
    if (second.joinable())
        second.join();
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace touchstone
