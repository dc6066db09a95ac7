// The counter that `locks_in_tick` stands on must see every lock.

#include "engine/core/realtime_guard.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <shared_mutex>

namespace touchstone::lock_guard_tests {
namespace {

template <class Work>
uint64_t locksIn(Work work) {
    realtime::resetViolations();
    {
        const realtime::TickScope scope;
        work();
    }
    return realtime::violations().locks;
}

TEST(LockGuard, SeesEveryKindOfLockInATick) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    constexpr uint64_t kSeen = 0; // the sanitizer stands in its place
#else
    constexpr uint64_t kSeen = 1;
#endif
    EXPECT_EQ(realtime::locksAreCounted(), kSeen > 0);
    std::mutex mutex;
    std::recursive_mutex recursive;
    std::shared_mutex shared;
    EXPECT_EQ(locksIn([&] { const std::lock_guard lock(mutex); }), kSeen);
    EXPECT_EQ(locksIn([&] { const std::lock_guard lock(recursive); }), kSeen);
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(mutex, std::try_to_lock); }), kSeen);
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(shared); }), kSeen);
    EXPECT_EQ(locksIn([&] { const std::shared_lock lock(shared); }), kSeen);
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(shared, std::try_to_lock); }), kSeen);
    EXPECT_EQ(locksIn([&] { const std::shared_lock lock(shared, std::try_to_lock); }), kSeen);
    std::timed_mutex timed;
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(timed, std::chrono::milliseconds(1)); }), kSeen);
    EXPECT_EQ(locksIn([] {}), 0u);
}

TEST(LockGuard, LocksOutsideATickAreNobodysBusiness) {
    realtime::resetViolations();
    std::mutex mutex;
    mutex.lock();
    mutex.unlock();
    EXPECT_EQ(realtime::violations().locks, 0u);
}

} // namespace
} // namespace touchstone::lock_guard_tests
