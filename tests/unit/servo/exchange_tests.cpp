// Two threads against each other; the thread sanitizer (Threads.exchange) watches the same tests.

#include "engine/exchange/handover.h"
#include "engine/exchange/record_ring.h"
#include "engine/exchange/triple_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

namespace touchstone {
namespace {

/// Wide enough that a torn copy shows: every word must say the same.
struct Wide {
    std::array<uint64_t, 24> words{};

    static Wide of(uint64_t value) {
        Wide wide;
        wide.words.fill(value);
        return wide;
    }
    [[nodiscard]] bool whole() const {
        for (const uint64_t word : words)
            if (word != words[0])
                return false;
        return true;
    }
};

constexpr uint64_t kRounds = 200'000;

TEST(TripleBuffer, StartsWithTheInitialValueAndNothingNew) {
    TripleBuffer<int> buffer(7);
    EXPECT_FALSE(buffer.update());
    EXPECT_EQ(buffer.value(), 7);
    buffer.write(8);
    buffer.write(9);
    EXPECT_EQ(buffer.value(), 7) << "the reader's value holds until it asks";
    EXPECT_TRUE(buffer.update());
    EXPECT_EQ(buffer.value(), 9);
    EXPECT_FALSE(buffer.update());
    EXPECT_EQ(buffer.value(), 9);
}

TEST(TripleBuffer, TheReaderSeesWholeValuesInOrderAndTheLastOne) {
    TripleBuffer<Wide> buffer;
    std::thread writer([&] {
        for (uint64_t i = 1; i <= kRounds; ++i)
            buffer.write(Wide::of(i));
    });
    uint64_t last = 0, torn = 0, backwards = 0;
    while (last < kRounds) {
        if (!buffer.update()) {
            std::this_thread::yield();
            continue;
        }
        if (!buffer.value().whole())
            ++torn;
        if (buffer.value().words[0] <= last)
            ++backwards;
        last = buffer.value().words[0];
    }
    writer.join();
    EXPECT_EQ(torn, 0u);
    EXPECT_EQ(backwards, 0u);
    EXPECT_FALSE(buffer.update());
}

TEST(RecordRing, KeepsOrderAndCountsWhatDoesNotFit) {
    RecordRing<int> ring(4);
    ASSERT_EQ(ring.capacity(), 4u);
    for (int i = 0; i < 6; ++i)
        ring.push(i);
    EXPECT_EQ(ring.dropped(), 2u);
    int value = -1;
    for (int i = 0; i < 4; ++i) {
        ASSERT_TRUE(ring.pop(value));
        EXPECT_EQ(value, i);
    }
    EXPECT_FALSE(ring.pop(value));
    ring.push(9);
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, 9);
}

TEST(RecordRing, RoundsItsCapacityUp) {
    EXPECT_EQ(RecordRing<int>(0).capacity(), 2u);
    EXPECT_EQ(RecordRing<int>(1000).capacity(), 1024u);
}

TEST(RecordRing, EveryRecordArrivesOnceOrIsCounted) {
    RecordRing<Wide> ring(64);
    std::atomic<bool> finished{false};
    std::thread writer([&] {
        for (uint64_t i = 1; i <= kRounds; ++i) {
            ring.push(Wide::of(i));
            if (i % 32 == 0)
                std::this_thread::yield();
        }
        finished.store(true, std::memory_order_release);
    });
    uint64_t received = 0, last = 0, torn = 0, unordered = 0;
    Wide record;
    for (;;) {
        const bool end = finished.load(std::memory_order_acquire);
        while (ring.pop(record)) {
            if (!record.whole())
                ++torn;
            if (record.words[0] <= last)
                ++unordered;
            last = record.words[0];
            ++received;
        }
        if (end)
            break;
    }
    writer.join();
    EXPECT_EQ(received + ring.dropped(), kRounds);
    EXPECT_GT(received, 0u);
    EXPECT_EQ(torn, 0u);
    EXPECT_EQ(unordered, 0u);
}

/// Says who destroyed it, and falls into pieces when it is destroyed.
struct Traced {
    Traced(uint64_t number, std::atomic<int>& living, std::atomic<int>& strangers)
        : content(Wide::of(number)), living_(living), strangers_(strangers) {
        ++living_;
    }
    ~Traced() {
        if (std::this_thread::get_id() != owner_)
            ++strangers_;
        content.words[0] = ~content.words[1];
        --living_;
    }
    Traced(const Traced&) = delete;
    Traced& operator=(const Traced&) = delete;

    Wide content;

  private:
    std::atomic<int>& living_;
    std::atomic<int>& strangers_;
    std::thread::id owner_ = std::this_thread::get_id();
};

TEST(Handover, NothingUntilOfferedThenTheNewest) {
    std::atomic<int> living{0}, strangers{0};
    {
        Handover<Traced> handover;
        EXPECT_EQ(handover.adopt(), nullptr);
        handover.offer(std::make_shared<Traced>(1, living, strangers));
        EXPECT_TRUE(handover.pending());
        handover.offer(std::make_shared<Traced>(2, living, strangers));
        EXPECT_EQ(living, 1) << "an offer that nobody took is replaced at once";
        const Traced* adopted = handover.adopt();
        ASSERT_NE(adopted, nullptr);
        EXPECT_EQ(adopted->content.words[0], 2u);
        EXPECT_FALSE(handover.pending());
        handover.offer(std::make_shared<Traced>(3, living, strangers));
        EXPECT_EQ(adopted->content.words[0], 2u) << "still in use";
        EXPECT_EQ(handover.adopt()->content.words[0], 3u);
        EXPECT_EQ(living, 2) << "the servo frees nothing";
        handover.collect();
        EXPECT_EQ(living, 1);
    }
    EXPECT_EQ(living, 0);
    EXPECT_EQ(strangers, 0);
}

TEST(Handover, AnOfferWaitsWhileTheOldObjectIsNotCollected) {
    std::atomic<int> living{0}, strangers{0};
    Handover<Traced> handover;
    for (uint64_t i = 1; i <= 2; ++i) {
        handover.offer(std::make_shared<Traced>(i, living, strangers));
        ASSERT_EQ(handover.adopt()->content.words[0], i);
    }
    handover.offer(std::make_shared<Traced>(3, living, strangers)); // collects 1
    EXPECT_EQ(living, 2);
    EXPECT_EQ(handover.adopt()->content.words[0], 3u);
}

TEST(Handover, WhatIsNotReadyStaysAsideAndNewerOffersWaitBehindIt) {
    std::atomic<int> living{0}, strangers{0};
    {
        Handover<Traced> handover;
        uint64_t ready = 0; // the first number that is not
        const auto adopt = [&] {
            const Traced* const object =
                handover.adopt([&](const Traced* next) { return next->content.words[0] < ready; });
            return object != nullptr ? object->content.words[0] : 0;
        };
        handover.offer(std::make_shared<Traced>(1, living, strangers));
        EXPECT_EQ(adopt(), 0u);
        handover.offer(std::make_shared<Traced>(2, living, strangers));
        handover.offer(std::make_shared<Traced>(3, living, strangers)); // instead of 2
        EXPECT_EQ(living, 2);
        EXPECT_EQ(adopt(), 0u);
        ready = 2;
        EXPECT_EQ(adopt(), 1u);
        EXPECT_EQ(adopt(), 1u) << "3 is not ready";
        ready = 4;
        EXPECT_EQ(adopt(), 3u);
        handover.offer(std::make_shared<Traced>(5, living, strangers));
        EXPECT_EQ(adopt(), 3u);
    }
    EXPECT_EQ(living, 0) << "nor is what was aside leaked";
    EXPECT_EQ(strangers, 0);
}

TEST(Handover, TheServoNeverSeesAFreedObjectAndNeverFreesOne) {
    std::atomic<int> living{0}, strangers{0};
    std::atomic<bool> finished{false};
    uint64_t broken = 0, backwards = 0, last = 0, looks = 0;
    {
        Handover<Traced> handover;
        std::thread servo([&] {
            while (!finished.load(std::memory_order_acquire)) {
                const Traced* object = handover.adopt([&](const Traced*) { return ++looks % 3 == 0; });
                if (object == nullptr)
                    continue;
                if (!object->content.whole())
                    ++broken;
                if (object->content.words[0] < last)
                    ++backwards;
                last = object->content.words[0];
            }
            handover.adopt(); // the last offer may still wait
        });
        for (uint64_t i = 1; i <= 20'000; ++i) {
            handover.offer(std::make_shared<Traced>(i, living, strangers));
            EXPECT_LE(living, 5) << "offered, aside, current, released and one in the making";
            if (i % 7 == 0)
                handover.collect();
            if (i % 3 == 0)
                std::this_thread::yield();
        }
        while (handover.pending()) {
            handover.collect();
            std::this_thread::yield();
        }
        finished.store(true, std::memory_order_release);
        servo.join();
    }
    EXPECT_EQ(broken, 0u);
    EXPECT_EQ(backwards, 0u);
    EXPECT_EQ(living, 0);
    EXPECT_EQ(strangers, 0);
}

} // namespace
} // namespace touchstone
