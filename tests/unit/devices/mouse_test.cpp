#include "devices/mouse/mouse_device.h"
#include "devices/mouse/mouse_hand.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace touchstone::mouse_test {
namespace {

constexpr double kTick = 0.001;

/// Runs the servo over `ticks`, asking `goalAt(tick)` for a goal every 33rd tick as a 30 Hz window would.
template <class GoalAt, class Check>
void drive(MouseDevice& mouse, int ticks, GoalAt goalAt, Check check) {
    for (int tick = 0; tick < ticks; ++tick) {
        if (tick % 33 == 0)
            mouse.moveTo(goalAt(tick));
        check(tick, mouse.sample(tick * kTick));
    }
}

TEST(MouseDevice, KnowsNothingBeforeTheFirstGoal) {
    MouseDevice mouse;
    EXPECT_FALSE(mouse.sample(0.0).valid);
    mouse.moveTo({0.01, 0.02, 0.03});
    const DeviceSample sample = mouse.sample(0.001);
    EXPECT_TRUE(sample.valid);
    EXPECT_EQ(sample.position, glm::dvec3(0.01, 0.02, 0.03));
}

TEST(MouseDevice, NeitherJumpsNorJerksHoweverTheGoalJumps) {
    const MouseSmoothing smoothing;
    MouseDevice mouse(smoothing);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anywhere(-0.2, 0.2);
    glm::dvec3 previous(0.0), velocity(0.0);
    // An error of at most E = 2 vmax / w and a speed of at most vmax bound the acceleration by w^2 E + 2 w
    // vmax.
    const double largestStep = smoothing.maxSpeed * kTick;
    const double largestJerk = 4.0 * smoothing.frequency * smoothing.maxSpeed * kTick * kTick;
    drive(
        mouse, 20000, [&](int) { return glm::dvec3(anywhere(random), anywhere(random), anywhere(random)); },
        [&](int tick, const DeviceSample& sample) {
            if (tick > 0) {
                const glm::dvec3 step = sample.position - previous;
                ASSERT_LE(glm::length(step), largestStep * (1 + 1e-9)) << "tick " << tick;
                ASSERT_LE(glm::length(step - velocity), largestJerk * (1 + 1e-9)) << "tick " << tick;
                velocity = step;
            }
            ASSERT_LE(std::abs(sample.position.x), 0.2 + 0.02);
            previous = sample.position;
        });
}

TEST(MouseDevice, TurnsThirtyStepsASecondIntoAnEvenDrag) {
    MouseDevice mouse;
    const double speed = 0.1;
    double previous = 0.0, slowest = 1e9, fastest = 0.0;
    drive(
        mouse, 3000, [&](int tick) { return glm::dvec3(speed * tick * kTick, 0.0, 0.0); },
        [&](int tick, const DeviceSample& sample) {
            if (tick > 500) {
                const double v = (sample.position.x - previous) / kTick;
                slowest = std::min(slowest, v);
                fastest = std::max(fastest, v);
            }
            previous = sample.position.x;
        });
    // The goal itself moves at 0 and, for one tick, at 33 times the speed.
    EXPECT_GT(slowest, 0.7 * speed);
    EXPECT_LT(fastest, 1.3 * speed);
    EXPECT_NEAR(previous, speed * 3.0, speed * 0.1);
}

TEST(MouseDevice, ArrivesAndRests) {
    MouseDevice mouse;
    const glm::dvec3 goal(0.05, -0.03, 0.02);
    glm::dvec3 last(0.0);
    mouse.moveTo(glm::dvec3(0.0));
    (void)mouse.sample(0.0);
    drive(
        mouse, 2000, [&](int) { return goal; },
        [&](int, const DeviceSample& sample) { last = sample.position; });
    EXPECT_LT(glm::distance(last, goal), 1e-9);
}

TEST(MouseDevice, HasNoAgeWhileTheWindowIsSilent) {
    MouseDevice mouse;
    mouse.moveTo(glm::dvec3(0.01));
    for (const double time : {1.0, 1.5, 100.0}) {
        const DeviceSample sample = mouse.sample(time);
        EXPECT_TRUE(sample.valid);
        EXPECT_TRUE(sample.inSight);
        EXPECT_EQ(sample.begins, time == 1.0);
        EXPECT_EQ(sample.age, 0.0);
        EXPECT_EQ(sample.position, glm::dvec3(0.01));
    }
}

TEST(MouseDevice, AStalledServoResumesWhereItWas) {
    MouseDevice mouse;
    mouse.moveTo(glm::dvec3(0.0));
    (void)mouse.sample(0.0);
    mouse.moveTo({0.2, 0.0, 0.0});
    const double before = mouse.sample(0.001).position.x;
    const double after = mouse.sample(5.0).position.x;
    EXPECT_LE(after - before, MouseSmoothing{}.maxSpeed * MouseDevice::kLongestStep * (1 + 1e-9));
    EXPECT_EQ(mouse.sample(4.0).position.x, after) << "time that runs backwards moves nothing";
}

TEST(MouseDevice, StartsAnewAfterRelease) {
    MouseDevice mouse;
    mouse.moveTo(glm::dvec3(0.1));
    (void)mouse.sample(0.0);
    mouse.release();
    EXPECT_FALSE(mouse.sample(0.001).valid);
    EXPECT_TRUE(mouse.sample(0.001).inSight) << "lifted on purpose";
    mouse.moveTo({.position = glm::dvec3(-0.1), .buttons = 5});
    DeviceSample sample = mouse.sample(0.002);
    EXPECT_EQ(sample.position, glm::dvec3(-0.1));
    EXPECT_EQ(sample.buttons, 5u);
    EXPECT_TRUE(sample.begins);
    // Also where the servo has not seen that it was gone.
    mouse.release();
    mouse.moveTo(glm::dvec3(0.1));
    sample = mouse.sample(0.003);
    EXPECT_EQ(sample.position, glm::dvec3(0.1));
    EXPECT_TRUE(sample.begins);
}

TEST(MouseDevice, GoesAlongWithTheObjectThatItPointsAt) {
    MouseDevice mouse;
    mouse.moveTo({.position = glm::dvec3(0.0, 0.01, 0.0), .object = 1});
    std::vector<ObjectMotion> motions(2);
    for (int tick = 0; tick < 3000; ++tick) {
        motions[1].before = motions[1].workspaceFromObject;
        motions[1].workspaceFromObject.translation.x += 0.002; // 2 m/s, four times as fast as a hand
        mouse.feel({.objects = motions});
        const DeviceSample sample = mouse.sample(tick * kTick);
        ASSERT_TRUE(sample.valid);
        ASSERT_LT(glm::distance(sample.position,
                                motions[1].workspaceFromObject.translation + glm::dvec3(0.0, 0.01, 0.0)),
                  1e-12);
    }
    mouse.feel({});
    EXPECT_FALSE(mouse.sample(3.0).valid) << "another scene, in which there is no such object";
}

TEST(MouseDevice, IgnoresGoalsThatAreNoPlace) {
    MouseDevice mouse;
    mouse.moveTo(glm::dvec3(0.01));
    mouse.moveTo({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
    mouse.moveTo({0.0, std::numeric_limits<double>::infinity(), 0.0});
    EXPECT_EQ(mouse.sample(0.0).position, glm::dvec3(0.01));
}

TEST(MouseDevice, AllocatesNothing) {
    MouseDevice mouse;
    const uint64_t before = test::allocationsOnThisThread();
    drive(
        mouse, 1000, [](int tick) { return glm::dvec3(tick * 1e-5); }, [](int, const DeviceSample&) {});
    EXPECT_EQ(test::allocationsOnThisThread(), before);
    ::operator delete(::operator new(4)); // a call that may not be left out
    EXPECT_EQ(test::allocationsOnThisThread(), before + 1) << "the counter counts";
}

TEST(MouseHand, DragsInTheViewPlaneAndPushesInDepth) {
    MouseHand hand(glm::dvec3(0.0, 0.0, 0.1));
    ViewAxes view;
    view.right = {0.0, 0.0, -1.0}; // seen from the right
    view.up = {0.0, 1.0, 0.0};
    view.away = {-1.0, 0.0, 0.0};
    hand.drag(view, 0.01, 0.02);
    EXPECT_LT(glm::distance(hand.goal(), glm::dvec3(0.0, 0.02, 0.09)), 1e-15);
    hand.push(view, 0.03);
    EXPECT_LT(glm::distance(hand.goal(), glm::dvec3(-0.03, 0.02, 0.09)), 1e-15);
    hand.goHome();
    EXPECT_EQ(hand.goal(), glm::dvec3(0.0, 0.0, 0.1));
}

TEST(MouseHand, StaysWithinReach) {
    MouseHand hand(glm::dvec3(0.0), 0.1);
    hand.drag(ViewAxes{}, 5.0, -7.0);
    EXPECT_EQ(hand.goal(), glm::dvec3(0.1, -0.1, 0.0));
    hand.drag(ViewAxes{}, std::numeric_limits<double>::quiet_NaN(), 0.0);
    EXPECT_EQ(hand.goal(), glm::dvec3(0.1, -0.1, 0.0));
}

} // namespace
} // namespace touchstone::mouse_test
