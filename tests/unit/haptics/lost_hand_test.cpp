// A device that is unplugged in contact and comes back.

#include "assets/shapes.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/sample/hip_sample.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/tick/haptic_step.h"
#include "tests/support/touch_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace touchstone::lost_hand_test {
namespace {

/// A box of 0.1 m, touched by a device that may be gone.
struct LostHand {
    std::shared_ptr<const HapticScene> scene =
        compileHapticScene(test::sceneOf(assets::box(glm::dvec3(0.1))), Similarity{});
    HapticSettings settings;
    DeviceState state;
    WorldState world;
    HapticOutput output;
    std::vector<ObjectMotion> motions; ///< empty: at rest

    const HapticOutput& tick(const glm::dvec3& position, bool valid) {
        DeviceSample sample;
        sample.position = position;
        sample.valid = valid;
        TickInput input;
        input.hands = {&sample, 1};
        world.place(motions);
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

TEST(LostHand, AMissedSampleDoesNotEndTheContactWhileTheForceIsOff) {
    LostHand hand;
    hand.settings.forceEnabled = false;
    hand.press(0.06, 200);
    hand.press(0.048, 200);
    ASSERT_EQ(hand.output.command.force(), glm::dvec3(0.0));
    ASSERT_GT(hand.output.force.y, 0.5);
    hand.beGone(1);
    hand.press(0.048, 1);
    EXPECT_GT(hand.output.force.y, 0.5);
    EXPECT_FALSE(has(hand.output.flags, TickFlag::StartedInside));
    hand.settings.forceEnabled = true;
    hand.press(0.048, 1);
    ForceLimiter::restartRamp(hand.state.limiter);
    hand.beGone(static_cast<int>(0.8 * kForceRampOutTime / 1e-3));
    hand.press(0.048, 1);
    EXPECT_GT(hand.output.force.y, 0.5);
    hand.beGone(static_cast<int>(1.2 * kForceRampOutTime / 1e-3));
    hand.press(0.048, 1);
    EXPECT_TRUE(has(hand.output.flags, TickFlag::StartedInside)) << "longer is for good";
}

/// The box rises under the hand at 0.1 m/s, beside a second one that rests or that it carries along.
TEST(LostHand, ObjectsThatMoveOnUnseenTakeTheContactAlong) {
    for (const ContactMethod contact : {ContactMethod::Sweep, ContactMethod::Neighbourhood})
        for (const bool two : {false, true}) {
            LostHand hand;
            Scene scene = test::sceneOf(assets::box(glm::dvec3(0.1)));
            if (two)
                test::addShape(scene, assets::box(glm::dvec3(0.1)),
                               glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.0, 0.0)));
            hand.scene = compileHapticScene(scene, Similarity{});
            hand.scene->buildNeighbourhoods();
            hand.settings.contact = contact;
            hand.motions = hand.scene->restMotions;
            hand.press(0.06, 200);
            hand.press(0.048, 200);
            const double before = hand.output.force.y;
            ASSERT_GT(before, 0.5);
            double rise = 0.0;
            const auto move = [&] {
                hand.motions[0].before = hand.motions[0].workspaceFromObject;
                hand.motions[0].workspaceFromObject.translation.y += 1e-4;
                rise += 1e-4;
            };
            for (int i = 0; i < 10; ++i) {
                move();
                hand.tick({}, false);
            }
            move();
            hand.press(0.048 + rise, 1);
            EXPECT_FALSE(has(hand.output.flags, TickFlag::StartedInside));
            EXPECT_NEAR(hand.output.force.y, before, 0.05 * before);
        }
}

/// What comes over the place of a hand that is in the free and not seen pushes the proxy all the same: the
/// object whose frame the proxy is in, and another.
TEST(LostHand, AnObjectThatComesUnseenIsMet) {
    for (const size_t comes : {0u, 1u}) {
        LostHand hand;
        Scene scene = test::sceneOf(assets::box(glm::dvec3(0.1)));
        const double aside = comes == 0 ? 0.2 : 0.0, above = comes == 0 ? 0.0 : 0.154;
        test::addShape(scene, assets::box(glm::dvec3(0.1)),
                       glm::translate(glm::dmat4(1.0), glm::dvec3(aside, above, 0.0)));
        hand.scene = compileHapticScene(scene, Similarity{});
        hand.motions = hand.scene->restMotions;
        hand.press(0.051, 200);
        ASSERT_EQ(hand.output.contacts, 0u);
        ASSERT_EQ(hand.state.reference, 0);
        // The lower box rises by 3 mm; or the upper one slides in from the side, 3 mm over the lower, its
        // edge past the hand.
        if (comes == 1) {
            hand.motions[1].workspaceFromObject.translation = {0.0525, 0.1005, 0.0};
            hand.motions[1].before = hand.motions[1].workspaceFromObject;
            hand.press(0.051, 1);
            ASSERT_EQ(hand.output.contacts, 0u);
        }
        const glm::dvec3 way = comes == 0 ? glm::dvec3(0.0, 3e-4, 0.0) : glm::dvec3(-5e-4, 0.0, 0.0);
        for (int i = 0; i < 10; ++i) {
            hand.motions[comes].before = hand.motions[comes].workspaceFromObject;
            hand.motions[comes].workspaceFromObject.translation += way;
            hand.tick({}, false);
        }
        hand.motions[comes].before = hand.motions[comes].workspaceFromObject;
        hand.press(0.051, 1);
        EXPECT_FALSE(has(hand.output.flags, TickFlag::StartedInside));
        EXPECT_GT(hand.output.contacts, 0u) << comes;
        if (comes == 0) {
            EXPECT_NEAR(hand.output.proxy.y, 0.053, 1e-4);
            EXPECT_GT(hand.output.force.y, 0.5);
        } else {
            EXPECT_NEAR(hand.output.proxy.x, 0.0475 - 0.05, 1e-4) << "beside the face that came";
            EXPECT_LT(hand.output.force.x, -0.5);
        }
    }
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

TEST(LostHand, AcrossAGapTheHandHasGoneNowhere) {
    DeviceState state;
    uint32_t flags = 0;
    DeviceSample sample;
    sample.valid = true;
    sample.position = {0.1, 0.0, 0.0};
    EXPECT_TRUE(takeSample(sample, 1e-3, state, flags));
    EXPECT_EQ(state.travel, glm::dvec3(0.0));
    sample.position = {0.101, 0.0, 0.0};
    EXPECT_TRUE(takeSample(sample, 1e-3, state, flags));
    EXPECT_NEAR(state.travel.x, 1e-3, 1e-15);
    EXPECT_GT(state.velocity.x, 0.1);
    EXPECT_EQ(flags, 0u);
    sample.valid = false;
    EXPECT_FALSE(takeSample(sample, 1e-3, state, flags));
    EXPECT_TRUE(has(flags, TickFlag::InputInvalid));
    EXPECT_EQ(state.hip, glm::dvec3(0.101, 0.0, 0.0)) << "where it was last seen";
    EXPECT_EQ(state.unsampled, 1e-3);
    sample.valid = true;
    sample.position = {0.2, 0.0, 0.0};
    flags = 0;
    EXPECT_TRUE(takeSample(sample, 1e-3, state, flags));
    EXPECT_EQ(state.travel, glm::dvec3(0.0));
    EXPECT_EQ(state.velocity, glm::dvec3(0.0));
    EXPECT_EQ(state.unsampled, 0.0);
    EXPECT_EQ(flags, 0u) << "no hand went so fast";
    sample.position = {0.9, 0.0, 0.0};
    EXPECT_TRUE(takeSample(sample, 1e-3, state, flags));
    EXPECT_TRUE(has(flags, TickFlag::Teleported));
    for (const double broken : {1e7, -1e8, std::nan("")}) {
        sample.position = {0.0, broken, 0.0};
        EXPECT_FALSE(takeSample(sample, 1e-3, state, flags)) << broken;
    }
}

} // namespace
} // namespace touchstone::lost_hand_test
