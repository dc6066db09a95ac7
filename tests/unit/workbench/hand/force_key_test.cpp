// What a press of the force key comes to, whichever thread sees it, and when.

#include "workbench/touch/force_key.h"

#include <gtest/gtest.h>

namespace touchstone::force_key_test {
namespace {

TEST(ForceKey, TakesAwayAtOnceAndGivesBackInTheNextFrame) {
    ForceSwitch force;
    ForceKey key(force);
    bool on = true;
    for (int round = 0; round < 5; ++round) {
        key.press(true);
        EXPECT_TRUE(force.off()) << "no frame is waited for";
        on = key.settle(on, true, std::nullopt);
        EXPECT_FALSE(on);
        key.press(true);
        EXPECT_TRUE(force.off());
        on = key.settle(on, true, std::nullopt);
        EXPECT_TRUE(on);
        EXPECT_FALSE(force.off());
    }
}

/// A picture that stalls: who presses twice has seen nothing come of the first.
TEST(ForceKey, OfSeveralPressesBetweenTwoFramesTheOneThatTakesAwayWins) {
    for (int presses = 1; presses < 8; ++presses)
        for (const bool before : {true, false}) {
            ForceSwitch force;
            ForceKey key(force);
            key.set(before);
            bool on = key.settle(before, true, std::nullopt);
            ASSERT_EQ(on, before);
            for (int i = 0; i < presses; ++i)
                key.press(true);
            EXPECT_TRUE(force.off());
            on = key.settle(on, true, std::nullopt);
            EXPECT_EQ(on, !before && presses == 1) << presses << " presses";
            EXPECT_EQ(force.off(), !on);
            on = key.settle(on, true, std::nullopt);
            EXPECT_EQ(force.off(), !on) << "and stays";
            if (on)
                continue;
            key.press(true);
            EXPECT_TRUE(key.settle(on, true, std::nullopt)) << "pressed again it comes back";
            EXPECT_FALSE(force.off());
        }
}

TEST(ForceKey, OnlyTakesAwayWhileATextIsTypedOrWithModifiers) {
    ForceSwitch force;
    ForceKey key(force);
    bool on = true;
    for (int i = 0; i < 4; ++i) {
        key.press(true);
        on = key.settle(on, false, std::nullopt);
        EXPECT_FALSE(on);
        EXPECT_TRUE(force.off());
    }
    key.press(false);
    on = key.settle(on, true, std::nullopt);
    EXPECT_FALSE(on);
    key.set(true); // by its button
    EXPECT_FALSE(force.off());
    EXPECT_TRUE(key.settle(true, true, std::nullopt));
    key.press(false);
    key.press(true);
    EXPECT_FALSE(key.settle(true, true, std::nullopt)) << "in doubt it is off";
}

TEST(ForceKey, APressIsNotOverriddenByPanelsThatHaveNotSeenIt) {
    ForceSwitch force;
    ForceKey key(force);
    bool on = key.settle(true, true, std::nullopt);
    key.press(true);
    key.set(on); // as every frame does
    EXPECT_TRUE(force.off());
    on = key.settle(on, true, std::nullopt);
    EXPECT_FALSE(on);
}

TEST(ForceKey, CountsAPressOnceThoughTheWindowSeesItToo) {
    ForceSwitch force;
    ForceKey key(force);
    uint32_t watched = 0;
    bool on = true;
    for (int i = 0; i < 20; ++i) {
        const bool windowFirst = i % 3 == 0;
        if (windowFirst)
            key.pressInWindow(true, watched);
        key.press(true);
        ++watched;
        on = key.settle(on, true, watched);
        EXPECT_EQ(on, i % 2 == 1);
        if (!windowFirst)
            key.pressInWindow(true, watched);
        for (int frame = 0; frame < 50; ++frame)
            on = key.settle(on, true, watched);
        EXPECT_EQ(on, i % 2 == 1);
    }
}

TEST(ForceKey, WhatOnlyTheWindowSeesTakesTheForceAwayAllTheSame) {
    ForceSwitch force;
    ForceKey key(force);
    bool on = true;
    key.pressInWindow(true, 0u);
    for (int frame = 0; frame < 10; ++frame)
        on = key.settle(on, true, 0u);
    EXPECT_TRUE(force.off());
    EXPECT_FALSE(on);
    // Without a watch the window is all there is; but a press that the watch told before it went is none of
    // the window's.
    key.pressInWindow(true, std::nullopt);
    EXPECT_FALSE(key.settle(on, true, std::nullopt));
    for (int frame = 0; frame < 40; ++frame)
        on = key.settle(on, true, std::nullopt);
    EXPECT_FALSE(on);
    key.pressInWindow(true, std::nullopt);
    EXPECT_TRUE(key.settle(on, true, std::nullopt));
}

/// A watch that sleeps for longer than the window waits for it told the same press a second time: the force
/// came back.
TEST(ForceKey, APressThatTheWatchTellsLateIsNotASecondOne) {
    for (const int late : {6, 10, 25}) {
        ForceSwitch force;
        ForceKey key(force);
        uint32_t watched = 0;
        bool on = true;
        key.pressInWindow(true, watched);
        for (int frame = 0; frame < late; ++frame)
            on = key.settle(on, true, watched);
        EXPECT_FALSE(on) << late;
        key.press(true); // the watch's own
        ++watched;
        for (int frame = 0; frame < 60; ++frame)
            on = key.settle(on, true, watched);
        EXPECT_FALSE(on) << late;
        EXPECT_TRUE(force.off());
        // From then on each press toggles again.
        key.press(true);
        key.pressInWindow(true, ++watched);
        EXPECT_TRUE(key.settle(on, true, watched));
    }
}

} // namespace
} // namespace touchstone::force_key_test
