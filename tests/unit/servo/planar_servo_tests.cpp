// The haptic thread of a finger in the plane: forces within the limits whatever happens, none while the force
// is off, none where a curve comes to be around the finger.

#include "haptics/servo/planar_servo.h"
#include "haptics/settings/tick_flags.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <thread>

namespace touchstone {
namespace {

/// A hand that is where the test puts it.
struct Hand {
    DeviceSample sample{.valid = true};
    glm::dvec3 force{0.0}; ///< the last command
    uint64_t commands = 0;

    DevicePort port() {
        return {.context = this,
                .sample = [](void* self, double) noexcept { return static_cast<Hand*>(self)->sample; },
                .apply =
                    [](void* self, const DeviceCommand& command) noexcept {
                        static_cast<Hand*>(self)->force = command.force();
                        ++static_cast<Hand*>(self)->commands;
                    },
                .feel = nullptr};
    }
};

std::shared_ptr<const PlanarScene> arc() {
    return std::make_shared<const PlanarScene>(PlanarSurface(SmoothArc{}),
                                               PlanarRendering{.stiffness = 600.0});
}

/// `depth` m into the top of the arc.
glm::dvec3 at(double depth) {
    return {0.0, -depth, 0.0};
}

TEST(PlanarServo, PushesTheFingerOutAndHoldsItInThePlane) {
    Hand hand;
    hand.sample.position = at(-0.01);
    PlanarServo servo(hand.port());
    servo.offer(arc());
    for (int i = 0; i < 300; ++i)
        servo.step();
    EXPECT_EQ(hand.force, glm::dvec3(0.0)) << "in the air";
    hand.sample.position = at(0.001);
    hand.sample.position.z = 0.002;
    for (int i = 0; i < 10; ++i)
        servo.step();
    EXPECT_NEAR(hand.force.x, 0.0, 1e-9);
    EXPECT_NEAR(hand.force.y, 0.6, 1e-9);
    EXPECT_NEAR(hand.force.z, -PlanarServo::kPlaneStiffness * 0.002, 1e-9);
    hand.sample.position = at(0.001);
    hand.sample.position.z = 0.5;
    for (int i = 0; i < 10; ++i)
        servo.step();
    EXPECT_NEAR(hand.force.z, -PlanarServo::kPlaneForce, 1e-9);
}

TEST(PlanarServo, TheHandsTurnIsThePitch) {
    Hand hand;
    hand.sample.orientation = glm::angleAxis(0.3, glm::dvec3(0.0, 0.0, 1.0));
    PlanarServo servo(hand.port());
    servo.offer(arc());
    EXPECT_NEAR(servo.step().pose.pitch, 0.3, 1e-12);
    hand.sample.orientation = glm::angleAxis(M_PI / 2.0, glm::dvec3(0.0, 1.0, 0.0));
    EXPECT_EQ(servo.step().pose.pitch, 0.0) << "the axis points out of the plane";
}

TEST(PlanarServo, ACurveAroundTheFingerIsNotFeltBeforeItHasLeft) {
    Hand hand;
    hand.sample.position = at(0.003);
    PlanarServo servo(hand.port());
    servo.offer(arc());
    for (int i = 0; i < 500; ++i)
        ASSERT_FALSE(servo.step().felt.touching);
    EXPECT_EQ(hand.force, glm::dvec3(0.0));
    hand.sample.position = at(-0.001);
    servo.step();
    hand.sample.position = at(0.001);
    for (int i = 0; i < 200; ++i)
        servo.step();
    EXPECT_GT(hand.force.y, 0.5);
    // Another one, and a hand that was away for long.
    servo.offer(arc());
    for (int i = 0; i < 200; ++i)
        ASSERT_FALSE(servo.step().felt.touching);
    EXPECT_EQ(hand.force, glm::dvec3(0.0));
    hand.sample.position = at(-0.001);
    servo.step();
    hand.sample.valid = false;
    for (int i = 0; i < 100; ++i)
        servo.step();
    hand.sample = {.position = at(0.002), .valid = true};
    for (int i = 0; i < 100; ++i)
        ASSERT_FALSE(servo.step().felt.touching);
}

TEST(PlanarServo, ADisplayGetsTheContactLocationWithinItsLimits) {
    struct Display : Hand {
        PadLimits limits{.reach = 0.008, .rate = 0.05};
        glm::dvec2 location{0.0};
        uint64_t commands = 0;
    } display;
    Hand& hand = display;
    DevicePort port = hand.port();
    port.pad = [](void* self) noexcept { return static_cast<Display*>(static_cast<Hand*>(self))->limits; };
    port.applyPad = [](void* self, const PadCommand& command) noexcept {
        auto& own = *static_cast<Display*>(static_cast<Hand*>(self));
        own.location = command.location();
        ++own.commands;
    };
    PlanarServo servo(port);
    servo.offer(std::make_shared<const PlanarScene>(PlanarSurface(SmoothArc{}),
                                                    PlanarRendering{.location = PlanarLocation::Facets}));
    hand.sample.position = at(-0.01);
    servo.step();
    glm::dvec2 before(0.0);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) { // to and fro over the arc; the pad's middle is below the circle's centre
        const double angle = 0.3 * std::sin(0.01 * i);
        const glm::dvec2 centre =
            SmoothArc{}.centre() + 0.1195 * glm::dvec2(std::sin(angle), std::cos(angle));
        hand.sample.position = {centre.x, centre.y - 0.02, 0.0};
        const PlanarTick tick = servo.step();
        worst = std::max(worst, glm::length(display.location - before));
        before = display.location;
        EXPECT_TRUE(tick.felt.touching);
        EXPECT_EQ(tick.location.location(), display.location);
    }
    EXPECT_LE(worst, 0.05e-3 * (1.0 + 1e-12));
    EXPECT_GT(worst, 0.04e-3) << "faster than the display";
    servo.forceSwitch().takeAway(true);
    for (int i = 0; i < 100; ++i) {
        hand.sample.position.x += 1e-5;
        ASSERT_TRUE(servo.step().felt.touching);
        ASSERT_EQ(display.location, before) << "nothing moves on the skin without force";
    }
    display.limits = {};
    const uint64_t commands = display.commands;
    EXPECT_EQ(servo.step().location.location(), glm::dvec2(0.0));
    EXPECT_EQ(display.commands, commands) << "a device without a display gets none";
}

TEST(PlanarServo, ForceOffIsZeroWithinTheSlewLimit) {
    Hand hand;
    hand.sample.position = at(-0.001);
    PlanarServo servo(hand.port());
    servo.offer(arc());
    servo.step();
    hand.sample.position = at(0.004);
    for (int i = 0; i < 300; ++i)
        servo.step();
    EXPECT_GT(hand.force.y, 2.0);
    servo.forceSwitch().takeAway(true);
    servo.step();
    EXPECT_EQ(hand.force, glm::dvec3(0.0)) << "2.4 N fall within a tick at 8500 N/s";
}

TEST(PlanarServo, AnyInputKeepsTheLimits) {
    Hand hand;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    PlanarServo servo(hand.port());
    glm::dvec3 before(0.0);
    for (int i = 0; i < 200000; ++i) {
        if (random() % 500 == 0)
            servo.offer(
                random() % 5 == 0
                    ? nullptr
                    : std::make_shared<const PlanarScene>(
                          PlanarSurface(polygonOf({}, 2 + random() % 40)),
                          PlanarRendering{static_cast<PlanarForce>(random() % 3),
                                          static_cast<PlanarLocation>(random() % 3), TangentStep::AsPublished,
                                          std::pow(10.0, 2.0 + 3.0 * std::abs(unit(random)))}));
        DeviceSample& s = hand.sample;
        s.position = {0.06 * unit(random), 0.02 * unit(random), 0.01 * unit(random)};
        if (random() % 100 == 0)
            s.position.x = random() % 2 == 0 ? NAN : 1e300;
        s.valid = random() % 50 != 0;
        s.age = random() % 50 == 0 ? 0.1 : 0.0;
        s.begins = random() % 200 == 0;
        s.limits = {.maxForce = 4.0, .maxForceRate = 900.0};
        const PlanarTick tick = servo.step();
        const glm::dvec3 force = tick.command.force();
        ASSERT_TRUE(std::isfinite(force.x + force.y + force.z));
        ASSERT_LE(glm::length(force), 4.0);
        if (!has(tick.flags, TickFlag::ForceFault)) {
            ASSERT_LE(glm::length(force - before), 0.9 * (1.0 + 1e-12)) << i;
        }
        before = force;
    }
}

TEST(PlanarServo, ItsThreadTicksAndEndsWithZero) {
    Hand hand;
    hand.sample.position = at(-0.001);
    {
        PlanarServo servo(hand.port(), {.wantRealtime = false});
        servo.offer(arc());
        servo.start();
        while (servo.ticks() < 50)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_GT(servo.tick().tick, 0u);
        EXPECT_EQ(servo.tick().scene, 1u);
        servo.stop();
    }
    EXPECT_GE(hand.commands, 51u);
    EXPECT_EQ(hand.force, glm::dvec3(0.0));
}

} // namespace
} // namespace touchstone
