// The loop against a synthetic port; the thread sanitizer (Threads.exchange) watches the same tests. No test
// here asserts a time: machines stall.

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/servo/servo_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

namespace touchstone {
namespace {

/// A square of 0.1 m in the plane y = `height`, seen from above.
std::shared_ptr<const HapticScene> floorAt(float height) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {
        {-0.05f, height, -0.05f}, {-0.05f, height, 0.05f}, {0.05f, height, 0.05f}, {0.05f, height, -0.05f}};
    mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back(std::move(mesh));
    scene.materials.emplace_back();
    scene.nodes.emplace_back();
    scene.instances.push_back({.node = 0, .mesh = 0});
    return compileHapticScene(scene, Similarity{});
}

/// A hand that goes up and down through the floor, and remembers what it was sent. Servo thread until joined.
struct BouncingHand {
    std::vector<DeviceCommand> commands;
    size_t next = 0;
    std::atomic<uint64_t> samples{0};

    BouncingHand() { commands.resize(1 << 16); }

    DevicePort port() {
        return {.context = this,
                .sample =
                    [](void* context, double time) noexcept {
                        static_cast<BouncingHand*>(context)->samples.fetch_add(1, std::memory_order_relaxed);
                        DeviceSample sample;
                        sample.position = {0.0, 0.008 * std::cos(6.283185307179586 * 20.0 * time), 0.0};
                        sample.valid = true;
                        return sample;
                    },
                .apply =
                    [](void* context, const DeviceCommand& command) noexcept {
                        auto& hand = *static_cast<BouncingHand*>(context);
                        if (hand.next < hand.commands.size())
                            hand.commands[hand.next++] = command;
                    }};
    }
    void waitFor(uint64_t count) const {
        while (samples.load(std::memory_order_relaxed) < count)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
};

const ServoConfig kQuick{.rateHz = 2000.0, .ringCapacity = 256, .wantRealtime = false};

TEST(ServoLoop, RefusesARateOrAPortThatCannotWork) {
    BouncingHand hand;
    for (const double rate : {0.0, 99.0, 4001.0, std::nan("")})
        EXPECT_THROW(ServoLoop(hand.port(), {.rateHz = rate}), Error);
    EXPECT_THROW(ServoLoop(DevicePort{}), Error);
}

TEST(ServoLoop, TicksWithoutASceneAndSendsNothing) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.start();
    hand.waitFor(20);
    loop.stop();
    EXPECT_GE(loop.counters().ticks, 20u);
    for (size_t i = 0; i < hand.next; ++i)
        EXPECT_EQ(hand.commands[i].force(), glm::dvec3(0.0));
}

TEST(ServoLoop, TouchesTheSceneAndEndsWithAZeroCommand) {
    enterFloatMode();
    BouncingHand stepped; // without a clock, which may pass over the ticks in contact
    ServoLoop steps(stepped.port(), kQuick);
    steps.offerScene(floorAt(0.0f));
    for (uint64_t tick = 0; tick < 600; ++tick)
        (void)steps.step(tick);
    const auto pushed = [](const BouncingHand& of) {
        size_t count = 0;
        for (size_t i = 0; i < of.next; ++i)
            if (of.commands[i].force().y > 0.0)
                ++count;
        return count;
    };
    EXPECT_GT(pushed(stepped), 50u);

    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.offerScene(floorAt(0.0f));
    loop.start();
    hand.waitFor(600);
    loop.stop();
    ASSERT_GT(hand.next, 0u);
    EXPECT_GT(pushed(hand), 0u);
    EXPECT_EQ(hand.next, loop.counters().ticks + 1) << "one command a tick and the last";
    EXPECT_EQ(hand.commands[hand.next - 1].force(), glm::dvec3(0.0));
}

TEST(ServoLoop, TellsTheTimeOfItsStagesWhereItIsAsked) {
    for (const bool asked : {true, false}) {
        BouncingHand hand;
        ServoConfig config = kQuick;
        config.stageTimes = asked;
        ServoLoop loop(hand.port(), config);
        loop.offerScene(floorAt(0.0f));
        loop.start();
        hand.waitFor(200);
        loop.stop();
        TickRecord record;
        uint64_t received = 0;
        while (loop.popRecord(record)) {
            ++received;
            int64_t sum = 0;
            for (const int32_t ns : record.stageNs) {
                EXPECT_GE(ns, 0);
                sum += ns;
            }
            EXPECT_LE(sum, record.stepNs);
            EXPECT_EQ(sum > 0, asked);
        }
        EXPECT_GT(received, 100u);
    }
}

TEST(ServoLoop, RecordsEveryTickOrCountsIt) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.offerScene(floorAt(0.0f));
    loop.start();
    hand.waitFor(700); // the ring has 256: some must drop
    loop.stop();
    TickRecord record, previous;
    uint64_t received = 0, contacts = 0;
    while (loop.popRecord(record)) {
        if (received++ > 0) {
            EXPECT_GT(record.tick, previous.tick);
        }
        EXPECT_EQ(record.time, static_cast<double>(record.tick) / kQuick.rateHz);
        EXPECT_GT(record.stepNs, 0);
        if (record.output.contacts > 0)
            ++contacts;
        previous = record;
    }
    const ServoLoop::Counters counters = loop.counters();
    EXPECT_EQ(received + counters.droppedRecords, counters.ticks);
    EXPECT_GT(counters.droppedRecords, 0u);
    EXPECT_GT(contacts, 0u);
}

TEST(ServoLoop, SettingsReachTheTick) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.offerScene(floorAt(0.0f));
    HapticSettings settings;
    settings.forceEnabled = false;
    loop.setSettings(settings);
    loop.start();
    hand.waitFor(600);
    loop.stop();
    TickRecord record;
    double most = 0.0;
    while (loop.popRecord(record))
        most = std::max(most, glm::length(record.output.force));
    EXPECT_GT(most, 0.0) << "contact goes on";
    for (size_t i = 0; i < hand.next; ++i)
        ASSERT_EQ(hand.commands[i].force(), glm::dvec3(0.0));
}

TEST(ServoLoop, CommandsNeverJumpWhateverIsSwappedMeanwhile) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.offerScene(floorAt(0.0f));
    loop.start();
    std::vector<std::weak_ptr<const HapticScene>> offered;
    HapticSettings settings;
    for (int i = 0; i < 60; ++i) { // longer than a bounce: a new floor is felt when the hand has left it
        const auto scene = floorAt(0.001f * static_cast<float>(i % 3 - 1));
        offered.emplace_back(scene);
        loop.offerScene(scene);
        settings.stiffness = 500.0 + 10.0 * i;
        settings.friction = i % 2 == 0 ? FrictionMode::Off : FrictionMode::Zilles;
        loop.setSettings(settings);
        TickRecord record;
        while (loop.popRecord(record)) {
        }
        if (loop.updateSnapshot()) {
            EXPECT_TRUE(std::isfinite(loop.snapshot().output.force.y));
        }
        hand.waitFor(static_cast<uint64_t>(150 * i));
    }
    loop.stop();
    loop.updateSnapshot();
    size_t living = 0;
    for (const auto& scene : offered)
        if (!scene.expired())
            ++living;
    EXPECT_LE(living, 2u) << "old scenes are freed while the loop lives";

    const DeviceLimits limits;
    const double maxStep = limits.maxForceRate / kQuick.rateHz;
    glm::dvec3 previous{0.0};
    double most = 0.0;
    for (size_t i = 0; i + 1 < hand.next; ++i) { // the last is the zero at the stop
        const glm::dvec3 force = hand.commands[i].force();
        // A skipped deadline lengthens the tick, so only ticks in their turn obey the bound of one period.
        if (loop.counters().skipped == 0) {
            EXPECT_LE(glm::length(force - previous), maxStep * (1.0 + 1e-9));
        }
        most = std::max(most, glm::length(force));
        previous = force;
    }
    EXPECT_GT(most, 0.0);
    EXPECT_LE(most, limits.maxForce);
}

/// Without a scene the device was sent zero from one tick to the next, and with the scene after that nearly
/// all of what it had held before.
TEST(ServoLoop, WithoutASceneTheForceGoesToZeroAndBeginsThere) {
    struct StillHand {
        glm::dvec3 place{0.0, 0.01, 0.0}, force{0.0};
    } hand;
    const DevicePort port{.context = &hand,
                          .sample =
                              [](void* context, double) noexcept {
                                  DeviceSample sample;
                                  sample.position = static_cast<StillHand*>(context)->place;
                                  sample.valid = true;
                                  sample.limits.maxForceRate = 1000.0; // 1 N a tick
                                  return sample;
                              },
                          .apply =
                              [](void* context, const DeviceCommand& command) noexcept {
                                  static_cast<StillHand*>(context)->force = command.force();
                              }};
    enterFloatMode();
    ServoLoop loop(port, {.rateHz = 1000.0, .wantRealtime = false});
    const DeviceLimits limits;
    loop.offerScene(floorAt(0.0f));
    uint64_t tick = 0;
    const auto run = [&](int ticks) {
        for (int i = 0; i < ticks; ++i)
            (void)loop.step(tick++);
    };
    run(200);
    hand.place.y = -0.02;
    run(400);
    ASSERT_NEAR(hand.force.y, limits.maxForce, 1e-6);
    loop.offerScene(nullptr);
    for (int i = 1; i <= 9; ++i) {
        run(1);
        EXPECT_NEAR(hand.force.y, std::max(0.0, limits.maxForce - i), 1e-6) << i;
    }
    run(20);
    EXPECT_EQ(hand.force, glm::dvec3(0.0));
    loop.updateSnapshot();
    loop.offerScene(floorAt(0.0f));
    for (int i = 0; i < 200; ++i) {
        run(1);
        ASSERT_EQ(hand.force, glm::dvec3(0.0)) << "beneath the floor, where touch begins: tick " << i;
    }
    // A scene that comes while the force is still going goes on from there.
    hand.place.y = 0.01;
    loop.updateSnapshot();
    loop.offerScene(floorAt(0.0f));
    run(200);
    hand.place.y = -0.02;
    run(400);
    loop.updateSnapshot();
    loop.offerScene(nullptr);
    run(3);
    loop.updateSnapshot();
    loop.offerScene(floorAt(0.0f));
    glm::dvec3 before = hand.force;
    EXPECT_GT(before.y, 1.0);
    for (int i = 0; i < 20; ++i) {
        run(1);
        EXPECT_LE(glm::length(hand.force - before), 1.0 + 1e-9);
        before = hand.force;
    }
}

TEST(ServoLoop, StopsAndStartsAgain) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.offerScene(floorAt(0.0f));
    for (uint64_t round = 1; round <= 5; ++round) {
        loop.start();
        hand.waitFor(round * 20);
        loop.stop();
        loop.stop();
    }
    EXPECT_GE(loop.counters().ticks, 100u);
}

TEST(ServoLoop, StepsAreNumberedSoThatDroppedRecordsShow) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), {.rateHz = kQuick.rateHz, .ringCapacity = 8, .wantRealtime = false});
    loop.start();
    TickRecord record;
    uint64_t next = 0, missing = 0;
    const auto drain = [&] {
        while (loop.popRecord(record)) {
            EXPECT_GE(record.step, next);
            missing += record.step - next;
            next = record.step + 1;
        }
    };
    for (uint64_t round = 1; round <= 3; ++round) {
        hand.waitFor(round * 40);
        drain();
    }
    loop.stop();
    drain();
    missing += loop.counters().ticks - next; // at the end
    EXPECT_GT(missing, 0u);
    EXPECT_EQ(missing, loop.counters().droppedRecords);
}

TEST(ServoLoop, SaysWhatItWasGranted) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), {.rateHz = 1000.0});
    EXPECT_TRUE(loop.scheduling().policy.empty());
    loop.start();
    const std::string policy = loop.scheduling().policy;
    EXPECT_TRUE(policy.starts_with("SCHED_FIFO") || policy.starts_with("EEVDF") ||
                policy.starts_with("normal"))
        << policy;
    loop.stop();
}

TEST(ServoLoop, ASlowPortIsCountedAndNeverBunches) {
    struct SlowHand {
        double last = -1.0;
        uint64_t count = 0, slept = 0;
        bool backwards = false;
    } slow;
    DevicePort port{.context = &slow,
                    .sample =
                        [](void* context, double time) noexcept {
                            auto& hand = *static_cast<SlowHand*>(context);
                            if (time <= hand.last)
                                hand.backwards = true;
                            hand.last = time;
                            if (hand.count++ % 4 == 0) {
                                ++hand.slept;
                                std::this_thread::sleep_for(std::chrono::milliseconds(3));
                            }
                            return DeviceSample{};
                        },
                    .apply = [](void*, const DeviceCommand&) noexcept {}};
    ServoLoop loop(port, kQuick);
    loop.start();
    while (loop.counters().ticks < 40)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    loop.stop();
    const ServoLoop::Counters counters = loop.counters();
    EXPECT_GE(slow.slept, 10u);
    EXPECT_GE(counters.missed, slow.slept);
    EXPECT_GE(counters.skipped, 6u * slow.slept) << "3 ms cost 6 deadlines of 0.5 ms";
    EXPECT_FALSE(slow.backwards);
    TickRecord record;
    uint64_t ticks = 0, last = 0;
    while (loop.popRecord(record)) {
        const uint64_t elapsed = ticks == 0 ? 1 : record.tick - last;
        EXPECT_DOUBLE_EQ(record.dt, static_cast<double>(elapsed) / kQuick.rateHz)
            << "what was skipped counts";
        ++ticks;
        last = record.tick;
    }
    EXPECT_EQ(ticks, counters.ticks);
    EXPECT_GE(last + 1, ticks);
    EXPECT_LE(last + 1, ticks + counters.skipped) << "every deadline was stepped or skipped";
}

TEST(ServoLoop, AStepThatIsMadeByHandKnowsItsTimeAndIsNotLate) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.offerScene(floorAt(0.0f));
    uint64_t steps = 0;
    for (const auto& [number, elapsed] :
         {std::pair<uint64_t, double>{0, 1.0}, {1, 1.0}, {2, 1.0}, {5, 3.0}}) {
        const TickRecord record = loop.step(number);
        EXPECT_EQ(record.tick, number);
        EXPECT_EQ(record.step, steps++);
        EXPECT_DOUBLE_EQ(record.time, static_cast<double>(number) / 2000.0);
        EXPECT_DOUBLE_EQ(record.dt, elapsed / 2000.0);
        EXPECT_FALSE(record.late);
        EXPECT_FALSE(record.missed);
        EXPECT_EQ(record.checkpoint, number == 0);
        EXPECT_EQ(record.scene, 1u);
    }
    EXPECT_EQ(loop.counters().ticks, 4u);
    TickRecord read;
    ASSERT_TRUE(loop.popRecord(read));
    EXPECT_EQ(read.tick, 0u);
    TouchCheckpoint checkpoint;
    ASSERT_TRUE(loop.popCheckpoint(checkpoint));
    EXPECT_EQ(checkpoint.tick, 0u);
    EXPECT_EQ(checkpoint.scene, 1u);
    EXPECT_FALSE(loop.popCheckpoint(checkpoint)) << "one a second";
}

TEST(ServoLoop, WithoutTheWishItAsksForNoPriority) {
    BouncingHand hand;
    ServoLoop loop(hand.port(), kQuick);
    loop.start();
    EXPECT_EQ(loop.scheduling().policy, "normal");
    EXPECT_FALSE(loop.scheduling().memoryLocked);
    EXPECT_EQ(loop.scheduling().pinnedCpu, -1);
    loop.stop();
}

} // namespace
} // namespace touchstone
