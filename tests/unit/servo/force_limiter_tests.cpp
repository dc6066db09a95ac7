#include "haptics/safety/force_limiter.h"
#include "haptics/settings/tick_flags.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace touchstone::force_limiter_tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1.0 + 1e-12;

SafetyInputs fresh() {
    SafetyInputs inputs;
    inputs.inputValid = true;
    return inputs;
}

/// A limiter with its memory, ticked like a servo ticks it.
struct Ticker {
    ForceLimiterState state;
    SafetyInputs inputs = fresh();
    Similarity workspaceFromDevice;
    uint32_t flags = 0;
    glm::dvec3 command{0.0};

    glm::dvec3 tick(const glm::dvec3& force, const glm::dvec3& torque = glm::dvec3(0.0)) {
        flags = 0;
        command = ForceLimiter::limit(force, torque, inputs, workspaceFromDevice, state, flags).force();
        return command;
    }
    glm::dvec3 settle(const glm::dvec3& force, double seconds = 2.0 * kForceRampInTime) {
        for (double t = 0.0; t < seconds; t += inputs.dt)
            tick(force);
        return command;
    }
};

TEST(ForceLimiter, PassesAForceWithinTheLimitsUnchanged) {
    Ticker ticker;
    const glm::dvec3 force{1.0, -2.0, 3.0};
    EXPECT_EQ(ticker.settle(force), force);
    EXPECT_EQ(ticker.flags, 0u);
}

/// While a servo stands still a device lets go (20 ms): what comes after the stall begins from nothing,
/// whatever the time that the tick counts for.
TEST(ForceLimiter, AfterAStallTheForceBeginsFromNothing) {
    for (const double rate : {850.0, 8500.0})
        for (const double stall : {0.021, 0.03, 0.12, 2.0, 1e6}) {
            Ticker ticker;
            ticker.inputs.limits.maxForceRate = rate;
            const glm::dvec3 force{0.0, 8.0, 0.0};
            ticker.settle(force);
            EXPECT_EQ(ticker.command, force);
            ticker.inputs.dt = stall;
            const double first = glm::length(ticker.tick(force));
            EXPECT_LE(first, std::min(rate * 0.02, 8.0 * 0.02 / kForceRampInTime) * kRounding) << stall;
            ticker.inputs.dt = 1e-3;
            double last = first;
            for (int i = 0; i < 200; ++i) {
                const double now = glm::length(ticker.tick(force));
                EXPECT_LE(now - last, rate * 1e-3 * kRounding);
                last = now;
            }
            EXPECT_EQ(ticker.command, force);
        }
}

TEST(ForceLimiter, LetsAsMuchPassAsTheClutchDoes) {
    Ticker ticker;
    const glm::dvec3 force{0.0, 4.0, 0.0};
    ticker.settle(force);
    for (const double coupling : {1.0, 0.75, 0.5, 0.25, 0.0, 0.4}) {
        ticker.inputs.coupling = coupling;
        EXPECT_NEAR(ticker.tick(force).y, 4.0 * coupling, 1e-12);
        EXPECT_EQ(has(ticker.flags, TickFlag::ForceRamping), coupling < 1.0);
    }
    // Of a force that is too large, it is the share of what the device can do: it fades from the first tick
    // on.
    ticker.inputs.coupling = 1.0;
    ticker.settle(10.0 * force);
    const double most = ticker.inputs.limits.maxForce;
    ticker.inputs.coupling = 0.9;
    EXPECT_NEAR(ticker.tick(10.0 * force).y, 0.9 * most, 1e-9);
    // No faster than the slew, and what is no share is none.
    ticker.inputs.limits.maxForceRate = 100.0;
    for (const double coupling : {0.0, kNaN, -1.0}) {
        ticker.inputs.coupling = 1.0;
        const double before = ticker.settle(force, 0.2).y;
        EXPECT_EQ(before, 4.0);
        ticker.inputs.coupling = coupling;
        EXPECT_NEAR(ticker.tick(force).y, before - 0.1, 1e-9);
        EXPECT_TRUE(has(ticker.flags, TickFlag::ForceRamping)) << coupling;
        EXPECT_EQ(ticker.settle(force).y, 0.0) << coupling;
    }
}

TEST(ForceLimiter, FadesInAfterTheStart) {
    Ticker ticker;
    const glm::dvec3 force{0.0, 4.0, 0.0};
    double previous = 0.0;
    const int ticks = static_cast<int>(std::ceil(kForceRampInTime / ticker.inputs.dt));
    for (int i = 1; i < ticks; ++i) {
        const double now = ticker.tick(force).y;
        EXPECT_GT(now, previous);
        EXPECT_NEAR(now, 4.0 * i * ticker.inputs.dt / kForceRampInTime, 1e-9);
        EXPECT_TRUE(has(ticker.flags, TickFlag::ForceRamping));
        previous = now;
    }
}

TEST(ForceLimiter, FadesInAnewAfterASceneSwapWithoutAJump) {
    Ticker ticker;
    const glm::dvec3 force{5.0, 0.0, 0.0};
    ticker.inputs.limits.maxForceRate = 500.0;
    ticker.settle(force);
    ForceLimiter::restartRamp(ticker.state);
    glm::dvec3 previous = ticker.command;
    double least = 5.0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 now = ticker.tick(force);
        EXPECT_LE(glm::length(now - previous), 500.0 * ticker.inputs.dt * kRounding);
        previous = now;
        least = std::min(least, now.x);
    }
    EXPECT_LT(least, 2.0);
    EXPECT_EQ(ticker.command, force);
}

TEST(ForceLimiter, ClampsTheMagnitudeAndKeepsTheDirection) {
    Ticker ticker;
    const glm::dvec3 force{30.0, -40.0, 0.0};
    const glm::dvec3 command = ticker.settle(force);
    EXPECT_LE(glm::length(command), ticker.inputs.limits.maxForce);
    EXPECT_NEAR(glm::length(command), ticker.inputs.limits.maxForce, 1e-12);
    EXPECT_NEAR(glm::dot(glm::normalize(command), glm::normalize(force)), 1.0, 1e-12);
    EXPECT_TRUE(has(ticker.flags, TickFlag::ForceLimited));
}

TEST(ForceLimiter, ForcesWhoseSquareOverflowsAreClampedNotFaulted) {
    Ticker ticker;
    const glm::dvec3 command = ticker.settle(glm::dvec3(1e308, 1e308, -1e308) * 0.5);
    EXPECT_NEAR(glm::length(command), ticker.inputs.limits.maxForce, 1e-9);
    EXPECT_EQ(ticker.state.faults, 0u);
}

TEST(ForceLimiter, AStepIsSlewed) {
    Ticker ticker;
    ticker.inputs.limits.maxForceRate = 100.0; // 0.1 N a tick
    ticker.settle(glm::dvec3(0.0));
    for (int i = 1; i <= 20; ++i) {
        EXPECT_NEAR(ticker.tick({2.0 * kRounding, 0.0, 0.0}).x, 0.1 * i, 1e-9);
    }
    EXPECT_NEAR(ticker.settle({2.0, 0.0, 0.0}).x, 2.0, 1e-12);
    // Turning round goes through the chord, never over a corner.
    glm::dvec3 previous = ticker.command;
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 now = ticker.tick({-2.0, 0.0, 0.0});
        EXPECT_LE(glm::length(now - previous), 0.1 * kRounding);
        previous = now;
    }
    EXPECT_EQ(previous.x, -2.0);
}

class ForceLimiterFault : public testing::TestWithParam<double> {};

TEST_P(ForceLimiterFault, DropsToZeroAtOnceAndStaysThereUntilReenabled) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool torqueIsBad : {false, true}) {
            Ticker ticker;
            ticker.settle({0.0, 5.0, 0.0});
            glm::dvec3 bad{1.0};
            bad[axis] = GetParam();
            if (torqueIsBad)
                ticker.tick(glm::dvec3(1.0), bad);
            else
                ticker.tick(bad);
            EXPECT_EQ(ticker.command, glm::dvec3(0.0));
            EXPECT_TRUE(has(ticker.flags, TickFlag::ForceFault));
            EXPECT_EQ(ticker.state.faults, 1u);
            EXPECT_EQ(ticker.settle({0.0, 5.0, 0.0}), glm::dvec3(0.0));
            EXPECT_TRUE(has(ticker.flags, TickFlag::SafetyLatched));
            EXPECT_FALSE(has(ticker.flags, TickFlag::ForceFault));
            ticker.inputs.forceEnabled = false;
            ticker.tick({0.0, 5.0, 0.0});
            EXPECT_FALSE(has(ticker.flags, TickFlag::SafetyLatched));
            ticker.inputs.forceEnabled = true;
            EXPECT_EQ(ticker.settle({0.0, 5.0, 0.0}), glm::dvec3(0.0, 5.0, 0.0));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(NotFinite, ForceLimiterFault, testing::Values(kNaN, kInfinity, -kInfinity));

TEST(ForceLimiter, ASenselessPeriodOrLimitIsAFault) {
    const auto faulted = [](auto change) {
        Ticker ticker;
        ticker.settle({0.0, 5.0, 0.0});
        change(ticker.inputs);
        ticker.tick({0.0, 5.0, 0.0});
        return ticker.command == glm::dvec3(0.0) && ticker.state.faults == 1 && ticker.state.latched;
    };
    for (const double bad : {kNaN, kInfinity, -1.0}) {
        EXPECT_TRUE(faulted([&](SafetyInputs& inputs) { inputs.dt = bad; }));
        EXPECT_TRUE(faulted([&](SafetyInputs& inputs) { inputs.limits.maxForce = bad; }));
        EXPECT_TRUE(faulted([&](SafetyInputs& inputs) { inputs.limits.maxForceRate = bad; }));
        EXPECT_TRUE(faulted([&](SafetyInputs& inputs) { inputs.limits.maxTorque = bad; }));
    }
}

TEST(ForceLimiter, StaleInputFadesOutFromTheLastFreshForce) {
    for (const bool unplugged : {false, true}) {
        Ticker ticker;
        ticker.settle({0.0, 5.0, 0.0});
        if (unplugged)
            ticker.inputs.inputValid = false;
        else
            ticker.inputs.sampleAge = ticker.inputs.limits.staleAge * 1.01;
        double previous = 5.0;
        const int ticks = static_cast<int>(std::lround(kForceRampOutTime / ticker.inputs.dt));
        for (int i = 1; i < ticks; ++i) {
            const double now = ticker.tick(glm::dvec3(0.0)).y; // the step itself knows nothing and says zero
            EXPECT_LT(now, previous);
            EXPECT_NEAR(now, 5.0 * (1.0 - i * ticker.inputs.dt / kForceRampOutTime), 1e-9);
            EXPECT_TRUE(has(ticker.flags, TickFlag::InputInvalid));
            previous = now;
        }
        EXPECT_EQ(ticker.settle(glm::dvec3(0.0)), glm::dvec3(0.0));
        ticker.inputs = fresh();
        ticker.tick({0.0, 5.0, 0.0});
        EXPECT_LT(ticker.command.y, 0.1) << "must fade in again";
    }
    Ticker ticker;
    ticker.settle({0.0, 5.0, 0.0});
    ticker.inputs.sampleAge = kNaN;
    ticker.tick({0.0, 5.0, 0.0});
    EXPECT_LT(ticker.command.y, 5.0);
    EXPECT_TRUE(has(ticker.flags, TickFlag::InputInvalid));
}

TEST(ForceLimiter, ASmallerLimitCutsAtOnce) {
    Ticker ticker;
    ticker.inputs.limits.maxForceRate = 100.0; // 0.1 N a tick
    ticker.settle({0.0, 5.0, 0.0});
    ticker.inputs.limits.maxForce = 2.0;
    EXPECT_NEAR(ticker.tick({0.0, 5.0, 0.0}).y, 2.0, 1e-12);
    EXPECT_TRUE(has(ticker.flags, TickFlag::ForceLimited));
    ticker.inputs.limits.maxForce = 8.0; // upwards it is slewed
    EXPECT_NEAR(ticker.tick({0.0, 5.0, 0.0}).y, 2.1, 1e-12);
}

TEST(ForceLimiter, TheForceOffKeyDoesNotWaitForAFade) {
    Ticker ticker;
    ticker.settle({0.0, 5.0, 0.0});
    ticker.inputs.forceEnabled = false;
    EXPECT_EQ(ticker.tick({0.0, 5.0, 0.0}), glm::dvec3(0.0)); // 5 N fit into one tick's slew of 8.5 N
}

TEST(ForceLimiter, LateTicksInARowFadeOutAndLatch) {
    Ticker ticker;
    ticker.settle({0.0, 5.0, 0.0});
    ticker.inputs.late = true;
    for (uint32_t i = 1; i < kLateTicksToLatch; ++i)
        EXPECT_EQ(ticker.tick({0.0, 5.0, 0.0}).y, 5.0);
    ticker.inputs.late = false;
    ticker.tick({0.0, 5.0, 0.0}); // not in a row: starts anew
    ticker.inputs.late = true;
    for (uint32_t i = 1; i < kLateTicksToLatch; ++i)
        EXPECT_EQ(ticker.tick({0.0, 5.0, 0.0}).y, 5.0);
    EXPECT_LT(ticker.tick({0.0, 5.0, 0.0}).y, 5.0);
    EXPECT_TRUE(has(ticker.flags, TickFlag::SafetyLatched));
    ticker.inputs.late = false;
    EXPECT_EQ(ticker.settle({0.0, 5.0, 0.0}), glm::dvec3(0.0));
    ForceLimiter::restartRamp(ticker.state); // a new scene does not mend a broken loop
    EXPECT_EQ(ticker.settle({0.0, 5.0, 0.0}), glm::dvec3(0.0));
}

TEST(ForceLimiter, TurnsForcesIntoTheDeviceFrame) {
    Ticker ticker;
    // Quarter turn about y: the device's x is the workspace's -z.
    ticker.workspaceFromDevice.rotation = glm::angleAxis(glm::radians(90.0), glm::dvec3(0.0, 1.0, 0.0));
    ticker.workspaceFromDevice.scale = 3.0;
    ticker.workspaceFromDevice.translation = {1.0, 2.0, 3.0};
    const glm::dvec3 command = ticker.settle({0.0, 0.0, -2.0});
    EXPECT_NEAR(glm::length(command - glm::dvec3(2.0, 0.0, 0.0)), 0.0, 1e-12);
}

TEST(ForceLimiter, TorqueHasItsOwnLimits) {
    ForceLimiterState state;
    SafetyInputs inputs = fresh();
    uint32_t flags = 0;
    const auto torque = [&](double most) {
        inputs.limits.maxTorque = most;
        inputs.limits.maxTorqueRate = 1000.0 * most;
        DeviceCommand command;
        for (int i = 0; i < 300; ++i)
            command = ForceLimiter::limit(glm::dvec3(0.0), {0.0, 9.0, 0.0}, inputs, {}, state, flags);
        return glm::length(command.torque());
    };
    EXPECT_EQ(torque(0.0), 0.0) << "a device that takes no torque gets none";
    EXPECT_NEAR(torque(0.5), 0.5, 1e-12);
}

/// Whatever comes, for as long as it comes.
TEST(ForceLimiter, NoStormGetsThroughTheLimits) {
    std::mt19937_64 random(20240611);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto chance = [&](double share) { return 0.5 * (unit(random) + 1.0) < share; };
    uint64_t faults = 0, clamped = 0;
    for (int storm = 0; storm < 200; ++storm) {
        Ticker ticker;
        ticker.inputs.limits.maxForce = std::pow(10.0, unit(random));
        ticker.inputs.limits.maxForceRate =
            std::pow(10.0, 3.0 * unit(random)) * ticker.inputs.limits.maxForce;
        ticker.workspaceFromDevice.rotation =
            glm::normalize(glm::dquat(unit(random), unit(random), unit(random), unit(random) + 2.0));
        glm::dvec3 previous{0.0};
        for (int i = 0; i < 2000; ++i) {
            ticker.inputs.dt = std::pow(10.0, -3.0 + unit(random));
            ticker.inputs.inputValid = !chance(0.02);
            ticker.inputs.sampleAge = chance(0.02) ? 1.0 : 0.0;
            ticker.inputs.forceEnabled = !chance(0.01);
            ticker.inputs.late = chance(0.3);
            if (chance(0.005))
                ForceLimiter::restartRamp(ticker.state);
            const double size = std::pow(10.0, chance(0.1) ? 300.0 * unit(random) : 2.0 * unit(random));
            glm::dvec3 force = size * glm::dvec3(unit(random), unit(random), unit(random));
            if (chance(0.001))
                force[i % 3] = chance(0.5) ? kNaN : kInfinity;
            const glm::dvec3 now = ticker.tick(force);
            ASSERT_TRUE(std::isfinite(now.x) && std::isfinite(now.y) && std::isfinite(now.z));
            ASSERT_LE(glm::length(now), ticker.inputs.limits.maxForce);
            if (has(ticker.flags, TickFlag::ForceFault)) {
                ASSERT_EQ(now, glm::dvec3(0.0));
                ++faults;
            } else {
                ASSERT_LE(glm::length(now - previous),
                          ticker.inputs.limits.maxForceRate * ticker.inputs.dt * kRounding + 1e-15);
            }
            if (has(ticker.flags, TickFlag::ForceLimited))
                ++clamped;
            previous = now;
        }
    }
    EXPECT_GT(faults, 50u) << "the storm was too mild to mean anything";
    EXPECT_GT(clamped, 10000u) << "the storm was too mild to mean anything";
}

TEST(ForceLimiter, EveryLimitMustBeANumberThatIsNotNegativeAndMayBeZero) {
    double DeviceLimits::*const limits[] = {&DeviceLimits::maxForce,          &DeviceLimits::maxForceRate,
                                            &DeviceLimits::maxTorque,         &DeviceLimits::maxTorqueRate,
                                            &DeviceLimits::apparentMass,      &DeviceLimits::coulombFriction,
                                            &DeviceLimits::positionResolution};
    for (double DeviceLimits::*limit : limits)
        for (const double value : {kNaN, kInfinity, -1.0, 0.0}) {
            Ticker ticker;
            ticker.settle({0.0, 5.0, 0.0});
            ticker.inputs.limits.*limit = value;
            ticker.tick({0.0, 5.0, 0.0});
            EXPECT_EQ(ticker.state.faults, value == 0.0 ? 0u : 1u) << value;
        }
    Ticker weak;
    weak.inputs.limits.maxForce = 0.0; // a device without motors
    EXPECT_EQ(weak.settle({0.0, 5.0, 0.0}), glm::dvec3(0.0));
    EXPECT_TRUE(has(weak.flags, TickFlag::ForceLimited));
    weak.tick(glm::dvec3(0.0));
    EXPECT_FALSE(has(weak.flags, TickFlag::ForceLimited)) << "nothing is cut of nothing";
}

TEST(ForceLimiter, ASampleIsFreshUpToItsAge) {
    Ticker ticker;
    ticker.settle({0.0, 5.0, 0.0});
    ticker.inputs.sampleAge = ticker.inputs.limits.staleAge;
    EXPECT_EQ(ticker.tick({0.0, 4.0, 0.0}), glm::dvec3(0.0, 4.0, 0.0));
    EXPECT_FALSE(has(ticker.flags, TickFlag::InputInvalid));
    ticker.inputs.sampleAge = std::nextafter(ticker.inputs.limits.staleAge, 1.0);
    ticker.tick({0.0, 4.0, 0.0});
    EXPECT_TRUE(has(ticker.flags, TickFlag::InputInvalid));
    EXPECT_LT(ticker.command.y, 4.0);
}

} // namespace
} // namespace touchstone::force_limiter_tests
