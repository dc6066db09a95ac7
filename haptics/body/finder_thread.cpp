#include "haptics/body/finder_thread.h"

#include "engine/core/float_mode.h"

#include <chrono>
#include <utility>

namespace touchstone::body {

FinderThread::FinderThread(std::shared_ptr<ContactFinder> finder, const FinderInput& input,
                           const FinderOutput& output)
    : finder_(std::move(finder)), input_(input), output_(output), found_(output), thread_([this] { run(); }) {
}

FinderThread::~FinderThread() {
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
}

void FinderThread::run() {
    enterFloatMode(); // the replay's is the same
    // The servo never wakes a thread, which would be a call to the system in the tick: this one looks.
    constexpr auto kPause = std::chrono::microseconds(500);
    constexpr auto kIdle = std::chrono::milliseconds(2);
    auto last = std::chrono::steady_clock::now();
    while (!stopping_.load(std::memory_order_relaxed)) {
        if (!input_.update()) {
            const bool idle = std::chrono::steady_clock::now() - last > std::chrono::milliseconds(100);
            std::this_thread::sleep_for(idle ? kIdle : kPause);
            continue;
        }
        last = std::chrono::steady_clock::now();
        finder_->find(input_.value(), kAhead, found_);
        output_.write(found_);
        rounds_.fetch_add(1, std::memory_order_relaxed);
        // Twice the rate that is asked for is enough; a whole processor for contacts would be too much.
        std::this_thread::sleep_until(last + std::chrono::milliseconds(2));
    }
}

} // namespace touchstone::body
