// The counter that `allocations_in_tick` stands on must see every way to get memory.

#include "engine/core/realtime_guard.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace touchstone::allocation_guard_tests {
namespace {

/// What `work` allocates and frees within a tick. `keep` outlives the tick.
template <class Work>
RealtimeViolations countIn(Work work) {
    realtime::resetViolations();
    {
        const realtime::TickScope scope;
        work();
    }
    return realtime::violations();
}

void* volatile keep = nullptr;

TEST(AllocationGuard, IsLinkedIn) {
    EXPECT_TRUE(realtime::allocationsAreCounted());
}

TEST(AllocationGuard, CountsEveryWayToAllocate) {
    const auto counts = [](auto allocate) {
        const RealtimeViolations violations = countIn([&] { keep = allocate(); });
        std::free(keep);
        return violations.allocations;
    };
    EXPECT_EQ(counts([] { return std::malloc(100); }), 1u);
    EXPECT_EQ(counts([] { return std::calloc(10, 10); }), 1u);
    EXPECT_EQ(counts([] { return std::realloc(nullptr, 100); }), 1u);
    EXPECT_EQ(counts([] { return std::aligned_alloc(64, 128); }), 1u);
    EXPECT_EQ(counts([]() -> void* {
                  void* memory = nullptr;
                  return posix_memalign(&memory, 64, 128) == 0 ? memory : nullptr;
              }),
              1u);
}

TEST(AllocationGuard, CountsOperatorNewAndContainers) {
    EXPECT_EQ(countIn([] { keep = ::operator new(100); }).allocations, 1u);
    EXPECT_EQ(countIn([] { ::operator delete(keep); }).deallocations, 1u);
    struct alignas(64) Wide {
        char bytes[64];
    };
    Wide* wide = nullptr;
    EXPECT_EQ(countIn([&] { keep = wide = new Wide; }).allocations, 1u);
    EXPECT_EQ(countIn([&] { delete wide; }).deallocations, 1u);
    std::vector<int> values;
    EXPECT_EQ(countIn([&] { values.resize(1000); }).allocations, 1u);
    std::string text;
    EXPECT_GE(countIn([&] { text.assign(100, 'x'); }).allocations, 1u);
}

TEST(AllocationGuard, CountsFree) {
    void* memory = std::malloc(10);
    keep = memory;
    EXPECT_EQ(countIn([&] { std::free(memory); }).deallocations, 1u);
    EXPECT_EQ(countIn([] { std::free(nullptr); }).deallocations, 0u);
}

TEST(AllocationGuard, CountsNothingOutsideATickNorOnAnotherThread) {
    realtime::resetViolations();
    keep = std::malloc(10);
    std::free(keep);
    EXPECT_EQ(realtime::violations().allocations, 0u);
    std::atomic<bool> ticking{false}, allocated{false};
    std::thread other([&] {
        while (!ticking)
            std::this_thread::yield();
        keep = std::malloc(10);
        std::free(keep);
        allocated = true;
    });
    const RealtimeViolations violations = countIn([&] {
        ticking = true;
        while (!allocated)
            std::this_thread::yield();
    });
    other.join();
    EXPECT_EQ(violations.allocations, 0u);
}

} // namespace
} // namespace touchstone::allocation_guard_tests
