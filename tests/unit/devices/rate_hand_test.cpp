#include "devices/hid/rate_hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone {
namespace {

DeviceReading pushed(const glm::dvec3& push, const glm::dvec3& turn = glm::dvec3(0.0)) {
    DeviceReading reading;
    reading.push = push;
    reading.turn = turn;
    reading.valid = true;
    return reading;
}

TEST(RateHand, FullDeflectionMovesAtFullSpeed) {
    RateHand hand({.fullSpeed = 0.1, .reach = 10.0});
    for (int i = 0; i < 1000; ++i)
        hand.follow(pushed({1.0, 0.0, -1.0}), true, 1e-3);
    const glm::dvec3 before = hand.position();
    for (int i = 0; i < 1000; ++i)
        hand.follow(pushed({1.0, 0.0, -1.0}), true, 1e-3);
    EXPECT_NEAR(glm::length(hand.position() - before - glm::dvec3(0.1, 0.0, -0.1)), 0.0, 1e-9);
}

TEST(RateHand, ACapAtRestAndItsNoiseMoveNothing) {
    RateHand hand;
    for (int i = 0; i < 1000; ++i)
        hand.follow(pushed({0.015, -0.02, 0.0}, {0.01, 0.0, 0.0}), true, 1e-3);
    EXPECT_EQ(hand.position(), RateSettings{}.start);
    EXPECT_EQ(hand.orientation(), glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(RateHand, ASilentDeviceStopsInsteadOfDrifting) {
    RateHand hand;
    for (int i = 0; i < 200; ++i)
        hand.follow(pushed({1.0, 1.0, 1.0}), true, 1e-3);
    const glm::dvec3 before = hand.position();
    for (int i = 0; i < 2000; ++i)
        hand.follow(pushed({1.0, 1.0, 1.0}), false, 1e-3);
    EXPECT_LT(glm::length(hand.position() - before), 2.0 * 0.25 / 40.0);
    const glm::dvec3 stopped = hand.position();
    for (int i = 0; i < 1000; ++i)
        hand.follow(pushed({1.0, 1.0, 1.0}), false, 1e-3);
    EXPECT_NEAR(glm::length(hand.position() - stopped), 0.0, 1e-15);
}

TEST(RateHand, TurnsAboutTheAxisOfTheTwist) {
    RateHand hand({.fullTurn = 1.0, .smoothing = 1e6});
    for (int i = 0; i < 1000; ++i)
        hand.follow(pushed(glm::dvec3(0.0), {0.0, 1.0, 0.0}), true, 1e-3);
    EXPECT_NEAR(glm::angle(hand.orientation()), 1.0, 1e-9);
    EXPECT_NEAR(glm::axis(hand.orientation()).y, 1.0, 1e-12);
}

TEST(RateHand, WhateverComesItStaysInReachAndBelowItsSpeed) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const RateSettings settings;
    RateHand hand(settings);
    for (int i = 0; i < 100000; ++i) {
        DeviceReading reading =
            pushed({3.0 * unit(random), unit(random), 1.0}, {unit(random), 0.0, unit(random)});
        if (random() % 50 == 0)
            reading.push.x = std::nan("");
        const glm::dvec3 before = hand.position();
        const double dt = random() % 20 == 0 ? 5.0 : 1e-3;
        hand.follow(reading, random() % 10 != 0, dt);
        ASSERT_LE(glm::length(hand.position() - before),
                  std::sqrt(3.0) * settings.fullSpeed * std::min(dt, RateHand::kLongestStep) * (1 + 1e-12));
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_LE(std::abs(hand.position()[axis]), settings.reach);
        ASSERT_NEAR(glm::length(hand.orientation()), 1.0, 1e-9);
    }
}

} // namespace
} // namespace touchstone
