// A device that is unplugged in contact and comes back.

#include "assets/shapes.h"
#include "haptics/haptic_step.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/tick_flags.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

/// A box of 0.1 m, touched by a device that may be gone.
struct LostHand {
    std::shared_ptr<const HapticScene> scene =
        compileHapticScene(test::sceneOf(assets::box(glm::dvec3(0.1))), Similarity{});
    HapticSettings settings;
    DeviceState state;
    WorldState world;
    HapticOutput output;

    const HapticOutput& tick(const glm::dvec3& position, bool valid) {
        DeviceSample sample;
        sample.position = position;
        sample.valid = valid;
        TickInput input;
        input.devices = {&sample, 1};
        NoStopwatch none;
        hapticStep(*scene, settings, input, world, {&state, 1}, {&output, 1}, none);
        return output;
    }
    void press(double height, int ticks) {
        for (int i = 0; i < ticks; ++i)
            tick({0.0, height, 0.0}, true);
    }
    void beGone(int ticks) {
        for (int i = 0; i < ticks; ++i)
            tick({}, false);
    }
};

TEST(LostHand, AMissedSampleDoesNotEndTheContact) {
    LostHand hand;
    hand.press(0.06, 200);
    hand.press(0.048, 200);
    const double before = hand.output.command.force().y;
    ASSERT_GT(before, 0.5);
    hand.beGone(3);
    hand.press(0.048, 1);
    EXPECT_GT(hand.output.contacts, 0u);
    EXPECT_GT(hand.output.force.y, 0.5);
}

TEST(LostHand, WhoComesBackElsewhereIsNotPulledBack) {
    LostHand hand;
    hand.press(0.06, 200);
    hand.press(0.048, 200);
    ASSERT_GT(hand.output.command.force().y, 0.5);
    hand.beGone(static_cast<int>(2.0 * kForceRampOutTime / 1e-3));
    EXPECT_EQ(hand.output.command.force(), glm::dvec3(0.0));
    for (int i = 0; i < 500; ++i) { // deep inside, as with encoders that begin at zero again
        hand.tick({0.01, -0.02, 0.0}, true);
        ASSERT_EQ(hand.output.command.force(), glm::dvec3(0.0));
    }
    EXPECT_TRUE(has(hand.output.flags, TickFlag::StartedInside));
    hand.press(0.06, 200); // out
    hand.press(0.048, 200);
    EXPECT_GT(hand.output.command.force().y, 0.5) << "and it can be touched again";
}

} // namespace
} // namespace touchstone
