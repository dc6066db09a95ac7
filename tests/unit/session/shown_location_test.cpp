// In a scene the pad's location follows from normal and orientation, through the safety stage of the servo.

#include "session/device_port.h"
#include "session/session.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test {
namespace {

/// A hand over a level floor at y = 0, with a contact location display.
struct Hand final : Device {
    PadLimits limitsOfPad{.reach = 0.008, .rate = 10.0};
    DeviceSample next = at({0.0, 0.008, 0.0});
    glm::dvec2 shown{0.0};
    int shows = 0, forces = 0;

    [[nodiscard]] std::string name() const override { return "test"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] PadLimits pad() const noexcept override { return limitsOfPad; }
    [[nodiscard]] DeviceSample sample(double) noexcept override { return next; }
    void apply(const DeviceCommand&) noexcept override { ++forces; }
    void applyPad(const PadCommand& command) noexcept override {
        shown = command.location();
        ++shows;
    }
    void pitch(double angle) { next.orientation = glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)); }
};

class ShownLocation : public testing::Test {
  protected:
    ShownLocation() {
        const TouchedScene floor = floorScene(0.0f);
        session_.touch(floor.haptic, floor.source, floor.identity);
        steps(20);
        hand_.next.position.y = -0.001;
        steps(5);
        EXPECT_NEAR(glm::length(hand_.shown), 0.0, 1e-12) << "level on level";
    }
    void steps(int count) {
        for (int i = 0; i < count; ++i) {
            last_ = session_.servo().step(++number_);
            EXPECT_EQ(last_.pad.location, hand_.limitsOfPad.reach > 0.0 ? hand_.shown : glm::dvec2(0.0));
        }
    }

    Hand hand_;
    Session session_{{portOf(hand_)}, RecordedServo::kQuick};
    uint64_t number_ = 0;
    TickRecord last_;
};

TEST_F(ShownLocation, IsWhereThePadTouches) {
    hand_.pitch(0.2);
    steps(20);
    EXPECT_NEAR(hand_.shown.x, -0.2 * 0.02, 1e-12);
    EXPECT_NEAR(hand_.shown.y, 0.0, 1e-12);
    EXPECT_EQ(hand_.forces, hand_.shows);
    hand_.next.position.y = 0.008;
    hand_.pitch(-0.1);
    steps(20);
    EXPECT_NEAR(hand_.shown.x, -0.2 * 0.02, 1e-12) << "stays in the air";
    const PadLimits limits = hand_.limitsOfPad;
    hand_.limitsOfPad = {};
    const int shows = hand_.shows;
    steps(3);
    EXPECT_EQ(hand_.shows, shows) << "no display, no command";
    // The next display begins in its middle and goes there at its own rate, wherever this one was.
    hand_.limitsOfPad = limits;
    hand_.next.position.y = -0.001;
    steps(1);
    EXPECT_GT(glm::length(hand_.shown), 0.0);
    EXPECT_LE(glm::length(hand_.shown), limits.rate / 4000.0 * (1.0 + 1e-12));
    EXPECT_GT(hand_.shown.x, 0.0) << "from the middle, not from -4 mm";
}

TEST_F(ShownLocation, HoldsWhileTheForceIsOff) {
    hand_.pitch(0.1);
    steps(20);
    const glm::dvec2 held = hand_.shown;
    EXPECT_NEAR(held.x, -0.002, 1e-12);
    session_.forceSwitch().takeAway(true);
    for (int i = 0; i < 400; ++i) {
        hand_.pitch(0.1 - 1e-3 * i);
        steps(1);
        ASSERT_EQ(hand_.shown, held) << i << ": nothing moves on the skin without force";
        ASSERT_GT(last_.output.contacts, 0u);
    }
    ASSERT_TRUE(session_.forceSwitch().giveBack(session_.forceSwitch().state()));
    steps(1);
    EXPECT_NEAR(glm::length(hand_.shown - held), hand_.limitsOfPad.rate / 4000.0, 1e-12) << "at its rate";
    steps(20);
    EXPECT_NEAR(hand_.shown.x, 0.02 * 0.299, 1e-12);
}

TEST_F(ShownLocation, HoldsWhereTheDeviceIsLost) {
    hand_.pitch(0.1);
    steps(20);
    const glm::dvec2 held = hand_.shown;
    hand_.next.valid = false;
    for (int i = 0; i < 400; ++i) {
        hand_.pitch(0.1 - 1e-3 * i);
        steps(1);
        ASSERT_EQ(hand_.shown, held) << i;
    }
}

TEST_F(ShownLocation, HoldsWhereThePositionIsNoNumber) {
    hand_.pitch(0.1);
    steps(20);
    const glm::dvec2 held = hand_.shown;
    hand_.pitch(-0.1);
    // A position that is no number: the sample is refused.
    hand_.next.position.x = std::nan("");
    steps(20);
    EXPECT_EQ(hand_.shown, held);
}

TEST_F(ShownLocation, ASceneAndItsSettingsComeInOneTick) {
    const TouchedScene other = floorScene(0.002f);
    const uint32_t before = last_.scene;
    HapticSettings settings;
    settings.stiffness = 321.0;
    const uint32_t number = session_.touch(other.haptic, other.source, other.identity, settings);
    steps(1);
    EXPECT_NE(before, number);
    EXPECT_EQ(last_.scene, number);
    TickRecord record;
    size_t ticks = 0, ofTheOther = 0;
    while (session_.servo().popRecord(record)) {
        const bool its = session_.servo().settingsOf(record.settings).stiffness == 321.0;
        EXPECT_EQ(its, record.scene == number) << record.tick;
        ofTheOther += its ? 1 : 0;
        ++ticks;
    }
    EXPECT_GT(ticks, 20u);
    EXPECT_EQ(ofTheOther, 1u);
    // Newer settings count, and the same ones again change nothing.
    session_.set(settings);
    steps(1);
    const uint32_t same = last_.settings;
    settings.stiffness = 432.0;
    session_.set(settings);
    steps(1);
    EXPECT_GT(last_.settings, same);
    EXPECT_EQ(session_.servo().settingsOf(last_.settings).stiffness, 432.0);
}

/// What it is for: a tick that falls between the two calls has one scene with the other's settings.
TEST_F(ShownLocation, SettingsSentBeforeTheSceneReachTheOldOne) {
    const TouchedScene other = floorScene(0.002f);
    const uint32_t before = last_.scene;
    HapticSettings settings;
    settings.stiffness = 321.0;
    session_.set(settings);
    steps(1);
    EXPECT_EQ(last_.scene, before);
    EXPECT_EQ(session_.servo().settingsOf(last_.settings).stiffness, 321.0);
    session_.touch(other.haptic, other.source, other.identity);
    steps(1);
    EXPECT_NE(last_.scene, before);
}

} // namespace
} // namespace touchstone::test
