// The counter that `locks_in_tick` stands on must see every lock.

#include "engine/core/realtime_guard.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <shared_mutex>

namespace touchstone {
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
    if (!realtime::locksAreCounted())
        GTEST_SKIP() << "a sanitizer stands in its place";
    std::mutex mutex;
    std::recursive_mutex recursive;
    std::shared_mutex shared;
    EXPECT_EQ(locksIn([&] { const std::lock_guard lock(mutex); }), 1u);
    EXPECT_EQ(locksIn([&] { const std::lock_guard lock(recursive); }), 1u);
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(mutex, std::try_to_lock); }), 1u);
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(shared); }), 1u);
    EXPECT_EQ(locksIn([&] { const std::shared_lock lock(shared); }), 1u);
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(shared, std::try_to_lock); }), 1u);
    EXPECT_EQ(locksIn([&] { const std::shared_lock lock(shared, std::try_to_lock); }), 1u);
    std::timed_mutex timed;
    EXPECT_EQ(locksIn([&] { const std::unique_lock lock(timed, std::chrono::milliseconds(1)); }), 1u);
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
} // namespace touchstone
