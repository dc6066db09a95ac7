// A device that says nothing for a while and comes back elsewhere: unplugged, or frozen.

#include "haptics/query/surface_pick.h"
#include "tests/stability/handover/stepped_servo.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test::lost_device_test {
namespace {

/// A device that presses 3 mm deep on a box.
struct PressedBox {
    PressedBox() : servo(device) {
        (void)servo.loop.offerScene(box.haptic, box.source);
        rest(0.01, 200);
        rest(-0.003, 200);
    }
    [[nodiscard]] DeviceSample over(double height) const { return at(place.point + height * place.normal); }
    void rest(double height, int ticks) {
        for (int i = 0; i < ticks; ++i) {
            device.next = over(height);
            servo.step();
        }
    }
    /// It says nothing: what it said last grows old, or there is nothing.
    void beSilent(bool frozen, int ticks) {
        for (int i = 0; i < ticks; ++i) {
            device.next.valid = frozen;
            device.next.age += 1e-3;
            servo.step();
        }
    }
    [[nodiscard]] double force() const { return glm::length(device.command.force()); }
    [[nodiscard]] bool touching() const { return servo.record.output.contacts > 0; }

    TouchedScene box = touchedScene("box.glb");
    SurfacePick place = pickSurface(*box.haptic, {}, {0.01, 0.5, 0.02}, {0.0, -1.0, 0.0}).value();
    PlacedDevice device;
    SteppedServo servo;
};

/// A frozen one was pulled out of the model with all that it can give.
TEST(LostDevice, WhoComesBackDeepInsideFeelsNothingBeforeTheHandHasLeft) {
    for (const bool frozen : {false, true}) {
        SCOPED_TRACE(frozen ? "frozen" : "unplugged");
        PressedBox hand;
        ASSERT_GT(hand.force(), 0.5);
        hand.beSilent(frozen, 100);
        EXPECT_EQ(hand.force(), 0.0);
        for (int i = 0; i < 300; ++i) {
            hand.rest(-0.03, 1);
            ASSERT_EQ(hand.force(), 0.0) << "tick " << i;
        }
        EXPECT_TRUE(has(hand.servo.record.output.flags, TickFlag::StartedInside));
        hand.rest(0.01, 10);
        hand.rest(-0.003, 300);
        EXPECT_GT(hand.force(), 0.5) << "and it can be touched again";
    }
}

TEST(LostDevice, AShortSilenceDoesNotEndTheTouch) {
    for (const bool frozen : {false, true}) {
        PressedBox hand;
        hand.beSilent(frozen, 40);
        hand.rest(-0.003, 1);
        EXPECT_TRUE(hand.touching()) << frozen;
        hand.rest(-0.003, 200);
        EXPECT_GT(hand.force(), 0.5);
    }
}

/// Nor is a place that was true long ago believed where the age is no number.
TEST(LostDevice, AnAgeThatIsNoNumberIsNotFresh) {
    PressedBox hand;
    hand.device.next.age = NAN;
    for (int i = 0; i < 100; ++i)
        hand.servo.step();
    EXPECT_EQ(hand.force(), 0.0);
    EXPECT_FALSE(hand.touching());
}

} // namespace
} // namespace touchstone::test::lost_device_test
