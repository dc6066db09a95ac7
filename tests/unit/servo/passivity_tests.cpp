#include "haptics/safety/force_limiter.h"
#include "haptics/safety/passivity.h"
#include "haptics/settings/tick_flags.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace touchstone::passivity_tests {
namespace {

constexpr double kTick = 1e-3;
constexpr double kMuch = 1e9;

/// No friction, exact sensor.
DeviceLimits exactDevice() {
    DeviceLimits limits;
    limits.positionResolution = 0.0;
    return limits;
}

TEST(PassivityObserver, AddsUpTheWorkOfHeldForces) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(any(random), any(random), any(random)); };
    PassivityState state;
    double work = 0.0;
    glm::dvec3 last = vector();
    observeEnergy(vector(), last, kMuch, exactDevice(), state);
    EXPECT_EQ(state.balance, 0.0) << "no way yet";
    for (int tick = 0; tick < 1000; ++tick) {
        const glm::dvec3 force = vector(), position = vector();
        observeEnergy(force, position, kMuch, exactDevice(), state);
        work += glm::dot(force, position - last);
        last = position;
        ASSERT_NEAR(state.balance, work, 1e-12);
    }
}

TEST(PassivityObserver, CountsWhatSamplingASpringGives) {
    // N ticks of s into a wall of stiffness k and N ticks out: each gives k s² / 2 more than the spring's
    // own.
    const double k = 1000.0, s = 1e-4;
    const int n = 20;
    PassivityState state;
    glm::dvec3 held(0.0);
    for (int tick = 0; tick <= 2 * n; ++tick) {
        const double depth = s * (tick <= n ? tick : 2 * n - tick);
        observeEnergy(held, {0, -depth, 0}, 0.5 * k * depth * depth, exactDevice(), state);
        held = {0, k * depth, 0};
    }
    EXPECT_NEAR(state.balance, k * s * s * n, 1e-15);
}

TEST(PassivityObserver, WhatCannotBeStoredIsNoCredit) {
    PassivityState state;
    observeEnergy({}, {0, 0, 0}, 0.0, exactDevice(), state);
    // A brake takes 1 J in all, of which a spring of 2 mJ may come back.
    for (int tick = 1; tick <= 1000; ++tick)
        observeEnergy({-1, 0, 0}, {1e-3 * tick, 0, 0}, 2e-3, exactDevice(), state);
    EXPECT_NEAR(state.balance, -2e-3, 1e-15);
    observeEnergy({-1, 0, 0}, {0.997, 0, 0}, 2e-3, exactDevice(), state);
    EXPECT_NEAR(state.balance, 1e-3, 1e-12) << "the third millijoule of 3 is a gift";
}

TEST(PassivityObserver, CountsFrictionOnlyForTheWayThatIsSure) {
    // A reading that flickers between two steps may be a hand at rest on the border: no friction.
    DeviceLimits limits;
    limits.positionResolution = 3e-5;
    limits.coulombFriction = 0.04;
    PassivityState state;
    for (int tick = 0; tick < 1000; ++tick)
        observeEnergy({}, {tick % 2 == 0 ? 0.0 : 3e-5, 0, 0}, 1.0, limits, state);
    EXPECT_NEAR(state.position.x, 1.5e-5, 1e-18);
    EXPECT_NEAR(state.balance, -0.04 * 1.5e-5, 1e-15) << "but for the way to the border";
    EXPECT_EQ(state.way, glm::dvec3(0.0));
    // Over many steps it is where the hand is, within half of one.
    for (int tick = 0; tick <= 300; ++tick)
        observeEnergy({}, {3e-5 * tick, 0, 0}, 1.0, limits, state);
    EXPECT_NEAR(state.position.x, 3e-5 * 299.5, 1e-15);
    EXPECT_NEAR(state.balance, -0.04 * 3e-5 * 299.5, 1e-12);
}

TEST(PassivityObserver, CountsABuzzBetweenTwoSteps) {
    // Out under 3 N and in under none, a step each: the wall throws, whatever the hand really did.
    DeviceLimits limits;
    limits.positionResolution = 3e-5;
    PassivityState state;
    for (int tick = 0; tick <= 100; ++tick)
        observeEnergy({tick % 2 == 0 ? 0.0 : 3.0, 0, 0}, {tick % 2 == 0 ? 0.0 : 3e-5, 0, 0}, 1.0, limits,
                      state);
    EXPECT_NEAR(state.balance, 50 * 3.0 * 3e-5, 1e-5);
}

TEST(PassivityObserver, TheDevicesOwnFrictionTakesItsShare) {
    DeviceLimits limits = exactDevice();
    limits.coulombFriction = 0.04;
    PassivityState state;
    observeEnergy({}, {0, 0, 0}, 0.0, limits, state);
    observeEnergy({1, 0, 0}, {1e-3, 0, 0}, 0.0, limits, state);
    EXPECT_NEAR(state.balance, 1e-3 - 0.04 * 1e-3, 1e-15);
}

TEST(PassivityObserver, KnowsOfADevicesDelay) {
    DeviceLimits limits = exactDevice();
    limits.commandDelay = true;
    PassivityState state;
    observeEnergy({1, 0, 0}, {0, 0, 0}, kMuch, limits, state);
    observeEnergy({2, 0, 0}, {0.1, 0, 0}, kMuch, limits, state); // held: 1 N
    observeEnergy({4, 0, 0}, {0.3, 0, 0}, kMuch, limits, state); // held: 2 N
    EXPECT_NEAR(state.balance, 0.1 + 0.4, 1e-15);
}

TEST(PassivityObserver, BeginsAnewWhereThePositionWasLost) {
    PassivityState state;
    observeEnergy({}, {0, 0, 0}, 0.0, exactDevice(), state);
    observeEnergy({1, 0, 0}, {0.01, 0, 0}, 0.0, exactDevice(), state);
    losePosition(state);
    observeEnergy({5, 0, 0}, {7.0, 0, 0}, 0.0, exactDevice(), state);
    EXPECT_NEAR(state.balance, 0.01, 1e-15) << "what happened unseen is not guessed";
}

TEST(PassivityController, TakesTheBalanceBackInOneTickAtTheSameSpeed) {
    PassivityState state;
    observeEnergy({}, {0, 0, 0}, 0.0, exactDevice(), state);
    const glm::dvec3 way{1e-4, -2e-4, 0};
    observeEnergy({0.05, 0, 0}, way, 0.0, exactDevice(), state);
    ASSERT_NEAR(state.balance, 5e-6, 1e-18);
    const glm::dvec3 damping = passiveForce({}, kTick, exactDevice(), state, 1.0);
    EXPECT_NEAR(glm::length(glm::cross(damping, way)), 0.0, 1e-18) << "along the motion";
    // a = E / (dt v²), Hannaford and Ryu.
    const double a = 5e-6 / (kTick * glm::dot(way, way) / (kTick * kTick));
    EXPECT_NEAR(glm::length(damping), a * glm::length(way) / kTick, 1e-12);
    observeEnergy(damping, 2.0 * way, 0.0, exactDevice(), state);
    EXPECT_NEAR(state.balance, 0.0, 1e-18);
    const glm::dvec3 force{1, 2, 3};
    EXPECT_EQ(passiveForce(force, kTick, exactDevice(), state, 1.0), force) << "nothing is owed";
}

TEST(PassivityController, DampsNoMoreThanAMassBearsAndThePushAlongTheMotion) {
    PassivityState state;
    state.balance = 0.25 * kMaxEnergy;
    state.way = {1e-4, 0, 0};
    const double most = 0.075 * kMaxDampingRate * 0.1; // N at 0.1 m/s
    const auto passive = [&](const glm::dvec3& force, double dt = kTick, double ramp = 1.0) {
        return passiveForce(force, dt, exactDevice(), state, ramp);
    };
    EXPECT_NEAR(passive({}).x, -most, 1e-12);
    EXPECT_NEAR(passive({2, 5, 0}).x, -most, 1e-12) << "what pushes is gone";
    EXPECT_NEAR(passive({2, 5, 0}).y, 0.75 * 5.0, 1e-12) << "across the motion it yields by a quarter";
    EXPECT_NEAR(passive({-2, 5, 0}).x, -most - 0.75 * 2.0, 1e-12);
    // In long ticks a damper must not turn the motion round: at most half of mass / dt.
    EXPECT_NEAR(passive({}, 0.01).x, -0.075 * 50.0 * 0.01, 1e-12);
    // While the force fades so does the damper, but for what the force pushes.
    EXPECT_NEAR(passive({2, 0, 0}, kTick, 0.25).x, -0.25 * most, 1e-12);
    EXPECT_EQ(passive({}, kTick, 0.0), glm::dvec3(0.0));
    state.way = {};
    EXPECT_EQ(passive({2, 0, 0}), glm::dvec3(1.5, 0, 0));
    state.balance = kMaxEnergy;
    EXPECT_EQ(passive({2, 0, 0}), glm::dvec3(0.0)) << "no force is left";
}

/// The limiter on a device that is dragged along +x by a force that pushes that way.
struct Dragged {
    Dragged() {
        inputs.inputValid = true;
        inputs.passivity = PassivityMode::Control;
        inputs.limits = exactDevice();
    }
    glm::dvec3 tick(const glm::dvec3& force) {
        inputs.position.x += 1e-4;
        flags = 0;
        return ForceLimiter::limit(force, {}, inputs, {}, state, flags).force();
    }
    ForceLimiterState state;
    SafetyInputs inputs;
    uint32_t flags = 0;
};

TEST(PassivityController, TakesAPushAlongTheMotionAway) {
    for (const PassivityMode mode : {PassivityMode::Off, PassivityMode::Observe, PassivityMode::Control}) {
        Dragged hand;
        hand.inputs.passivity = mode;
        glm::dvec3 command{0.0};
        double given = 0.0;
        for (int tick = 0; tick < 1000; ++tick) {
            given += command.x * 1e-4;
            command = hand.tick({2, 0, 0});
        }
        EXPECT_EQ(has(hand.flags, TickFlag::EnergyDamped), mode == PassivityMode::Control);
        EXPECT_TRUE(mode == PassivityMode::Control ||
                    has(hand.flags, TickFlag::EnergyGiven) == (mode == PassivityMode::Observe));
        if (mode == PassivityMode::Control)
            EXPECT_LT(given, 5e-4) << "of 190 mJ: at most what one tick gives";
        else
            EXPECT_NEAR(given, 2.0 * 1e-4 * 949.5, 1e-3);
        EXPECT_NEAR(hand.state.passivity.balance, mode == PassivityMode::Off ? 0.0 : given, 1e-3);
    }
}

TEST(PassivityController, IsOffWhereTheForceIsOff) {
    Dragged hand;
    for (int tick = 0; tick < 100; ++tick)
        (void)hand.tick({2, 0, 0});
    hand.state.passivity.balance = 1.0;
    hand.inputs.forceEnabled = false;
    for (int tick = 0; tick < 3; ++tick)
        EXPECT_EQ(hand.tick({2, 0, 0}), glm::dvec3(0.0));
    EXPECT_FALSE(has(hand.flags, TickFlag::EnergyDamped));
    hand.inputs.forceEnabled = true;
    hand.state.latched = true;
    EXPECT_EQ(hand.tick({2, 0, 0}), glm::dvec3(0.0));
    EXPECT_FALSE(has(hand.flags, TickFlag::EnergyDamped));
}

TEST(PassivityController, WhatIsOwedEndsWithTheModeAndTheScene) {
    for (const bool sceneSwap : {false, true}) {
        Dragged hand;
        for (int tick = 0; tick < 200; ++tick)
            (void)hand.tick({2, 0, 0});
        ASSERT_GT(hand.state.passivity.balance, 1e-5);
        hand.inputs.inputValid = false;
        (void)hand.tick({});
        EXPECT_GT(hand.state.passivity.balance, 1e-5) << "a lost sample is no payment";
        hand.inputs.inputValid = true;
        if (sceneSwap) {
            ForceLimiter::restartRamp(hand.state);
        } else {
            hand.inputs.passivity = PassivityMode::Off;
            (void)hand.tick({2, 0, 0});
        }
        EXPECT_EQ(hand.state.passivity.balance, 0.0);
        hand.inputs.passivity = PassivityMode::Control;
        hand.inputs.position.x -= 1e-4; // no way: nothing is given in the next tick
        (void)hand.tick({2, 0, 0});
        EXPECT_EQ(hand.state.passivity.balance, 0.0);
        EXPECT_FALSE(has(hand.flags, TickFlag::EnergyDamped));
    }
}

TEST(PassivityController, DoesNotDragWhereNothingPasses) {
    Dragged hand;
    for (int tick = 0; tick < 200; ++tick)
        (void)hand.tick({2, 0, 0});
    hand.inputs.sampleAge = 1.0; // stale: the force fades out
    for (int tick = 0; tick < 100; ++tick)
        (void)hand.tick({2, 0, 0});
    hand.state.passivity.balance = 1e-3;
    EXPECT_EQ(hand.tick({2, 0, 0}), glm::dvec3(0.0));
    EXPECT_FALSE(has(hand.flags, TickFlag::EnergyDamped));
}

TEST(PassivityController, NoStormGetsItThroughTheLimits) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto vector = [&](double size) { return size * glm::dvec3(any(random), any(random), any(random)); };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    Dragged hand;
    hand.inputs.limits.maxForceRate = 3000.0;
    glm::dvec3 last{0.0};
    uint64_t dampedTicks = 0;
    for (int tick = 0; tick < 300000; ++tick) {
        hand.inputs.position = vector(std::pow(10.0, 6.0 * any(random) - 3.0));
        hand.inputs.springLength = std::pow(10.0, 9.0 * any(random));
        if (tick % 97 == 0)
            hand.inputs.position.y = kNaN;
        if (tick % 89 == 0)
            hand.inputs.springLength = kNaN;
        if (tick % 83 == 0)
            hand.inputs.position.z = 1e300;
        hand.inputs.inputValid = any(random) > -0.9;
        hand.inputs.forceEnabled = tick % 5000 != 0;
        hand.flags = 0;
        const glm::dvec3 command =
            ForceLimiter::limit(vector(20.0), {}, hand.inputs, {}, hand.state, hand.flags).force();
        ASSERT_LE(glm::length(command), hand.inputs.limits.maxForce);
        ASSERT_LE(glm::distance(command, last), 3.0 * (1.0 + 1e-12)) << tick;
        ASSERT_FALSE(std::isnan(hand.state.passivity.balance)) << tick;
        dampedTicks += has(hand.flags, TickFlag::EnergyDamped);
        last = command;
    }
    EXPECT_GT(dampedTicks, 10000u);
}

} // namespace
} // namespace touchstone::passivity_tests
