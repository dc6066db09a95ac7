// The force key against a servo with a clock of its own: from the request to a command of zero.

#include "tests/stability/handover/stepped_servo.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

namespace touchstone::test::force_off_test {
namespace {

DeviceLimits limitsWith(double maxForceRate) {
    DeviceLimits limits;
    limits.maxForceRate = maxForceRate;
    return limits;
}

/// Presses until the device's full force is held.
struct PressedHand {
    explicit PressedHand(const DeviceLimits& limits) : servo(device) {
        const TouchedScene floor = floorScene(0.0f);
        device.own = limits;
        (void)servo.loop.offerScene(floor.haptic, floor.source);
        device.next = at({0.0, 0.01, 0.0});
        run(200);
        for (int i = 0; i < 400; ++i) {
            device.next.position.y -= 1e-4;
            servo.step();
        }
        run(2000);
    }
    void run(int ticks) {
        for (int i = 0; i < ticks; ++i)
            servo.step();
    }
    [[nodiscard]] double force() const { return glm::length(device.command.force()); }

    PlacedDevice device;
    SteppedServo servo;
};

TEST(ForceOff, TheCommandIsZeroAsFastAsTheDeviceMaySlew) {
    for (const double rate : {8500.0, 2000.0, 850.0, 100.0}) {
        PressedHand hand(limitsWith(rate));
        ASSERT_NEAR(hand.force(), 8.5, 1e-6);
        hand.servo.loop.forceSwitch().takeAway(true);
        const double bound = 8.5 / rate + 2e-3;
        double before = hand.force(), seconds = 0.0;
        while (hand.force() > 0.0 && seconds <= bound) {
            hand.servo.step();
            seconds += 1e-3;
            EXPECT_NEAR(hand.force(), std::max(0.0, before - rate * 1e-3), 1e-9)
                << "the target is zero at once";
            before = hand.force();
        }
        EXPECT_EQ(hand.force(), 0.0);
        EXPECT_LE(seconds, bound) << rate << " N/s";
        hand.run(1000);
        EXPECT_EQ(hand.force(), 0.0) << "and stays";
        EXPECT_GT(glm::length(hand.servo.record.output.force), 1.0) << "the contact goes on";
    }
}

TEST(ForceOff, IsGivenBackOnlyInTheStateThatWasLookedAt) {
    ForceSwitch force;
    force.takeAway(true);
    const ForceSwitch::State seen = force.state();
    force.takeAway(true);
    EXPECT_FALSE(force.giveBack(seen));
    EXPECT_TRUE(force.off());
    EXPECT_TRUE(force.giveBack(force.state()));
    EXPECT_FALSE(force.off());
    EXPECT_EQ(force.state().presses(), 2u);
    force.takeAway(false);
    EXPECT_TRUE(force.off());
    EXPECT_EQ(force.state().presses(), 2u);
    EXPECT_EQ(force.state().asked(), 3u);
}

TEST(ForceOff, NoRequestOfManyThreadsIsLost) {
    ForceSwitch force;
    constexpr int kThreads = 4, kPresses = 20000;
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t)
        threads.emplace_back([&force] {
            for (int i = 0; i < kPresses; ++i)
                force.takeAway(true);
        });
    for (int i = 0; i < kPresses; ++i)
        (void)force.giveBack(force.state());
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(force.state().presses(), static_cast<uint32_t>(kThreads * kPresses));
    EXPECT_EQ(force.state().asked(), static_cast<uint32_t>(kThreads * kPresses));
}

TEST(ForceOff, ReplaysToTheLastBit) {
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "r.tsrec";
    RecordedServo rig([](double time) { return at(overTheDoughnut(time)); },
                      {.rateHz = 1000.0, .ringCapacity = 1 << 14, .wantRealtime = false});
    rig.recorder.start(file, "test");
    rig.offer(touchedScene("doughnut.glb"));
    HapticSettings settings;
    for (int i = 0; i < 6; ++i) {
        rig.ticks(150);
        rig.servo.forceSwitch().takeAway(true);
        rig.ticks(60);
        EXPECT_EQ(rig.records.back().output.command.force(), glm::dvec3(0.0));
        EXPECT_FALSE(rig.servo.settingsOf(rig.records.back().settings).forceEnabled);
        settings.stiffness = 500.0 + 10.0 * i;
        rig.servo.setSettings(settings); // does not give it back
        rig.ticks(60);
        EXPECT_EQ(rig.records.back().output.command.force(), glm::dvec3(0.0));
        EXPECT_TRUE(rig.servo.forceSwitch().giveBack(rig.servo.forceSwitch().state()));
    }
    rig.ticks(200);
    EXPECT_TRUE(rig.servo.settingsOf(rig.records.back().settings).forceEnabled);
    rig.finish();
    rig.expectWithinLimits();
    EXPECT_GT(rig.inContact(), 100u);
    expectEqualReplay(replayOf(file, rig.scenes));
}

} // namespace
} // namespace touchstone::test::force_off_test
