// Contact apart from control [000 §7]: late or lost contact is sticky, never unstable, and gives no energy.

#include "haptics/control/proxy_spring.h"
#include "haptics/settings/tick_flags.h"
#include "study/rate/apart_loop.h"
#include "tests/stability/closed_loop/loop_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace touchstone::test {
namespace {

using study::ApartLoop;
using study::ApartOptions;

constexpr double kHz = 4000.0;

DeviceSample at(const glm::dvec3& position) {
    DeviceSample sample = sampleAt(position);
    sample.limits = noLimits();
    return sample;
}

ContactGoal wallAt(double y, double stiffness = 600.0) {
    return {.touching = true, .proxy = {0, y, 0}, .stiffness = stiffness};
}

double energyOf(const ProxySpring& spring, const glm::dvec3& hand) {
    const glm::dvec3 stretch = spring.end() - hand;
    return 0.5 * spring.stiffness() * glm::dot(stretch, stretch);
}

/// A Phantom in a light grip that meets a plane; what becomes of it.
Aftermath meetApart(const ApartOptions& options, const Start& start) {
    const PlantParameters phantom;
    ApartLoop loop(study::pressedPlane(), plainWall(options.stiffness), phantom, options, noLimits());
    const double depth = 0.7 / phantom.handStiffness + 0.7 / options.stiffness;
    const glm::dvec3 place{0.0131, 0.0, 0.0172};
    loop.intention = [=](double) { return place - glm::dvec3(0, depth, 0); };
    const glm::dvec3 begin = place + glm::dvec3(0, start.height, 0);
    loop.hold(place + glm::dvec3(0, 0.003, 0), begin);
    loop.release(begin, {0, -start.speed, 0});
    Aftermath result{.rests = true};
    double lowest = INFINITY, highest = -INFINITY;
    const int ticks = static_cast<int>(2.0 * kHz);
    for (int i = 0; i < ticks; ++i) {
        loop.tick();
        if (i > 3 * ticks / 4) {
            lowest = std::min(lowest, loop.plant().position().y);
            highest = std::max(highest, loop.plant().position().y);
        }
    }
    result.swing = highest - lowest;
    return result;
}

} // namespace

// [000 §8]: "stable results with position gains over 1800 Newtons/meter with no artificial damping".
TEST(ContactRate, EighteenHundredNewtonsAMetreWithoutDampingAtRestWhateverTheRateOfContact) {
    for (const int ticks : {4, 16, 40})
        for (const bool planes : {false, true})
            for (const Start& start : kWallStarts) {
                ApartOptions options{.controlTicks = ticks, .planes = planes, .stiffness = 1800.0};
                options.spring.power = INFINITY;
                const Aftermath apart = meetApart(options, start);
                EXPECT_LT(apart.swing, 1e-4)
                    << kHz / ticks << " Hz, planes " << planes << ", from " << start.height;
            }
    // The same wall where control runs at contact's 100 Hz.
    const Aftermath together = meetWall(PlantParameters{}, plainWall(1800.0), 100.0, kWallStarts[0], 2.0);
    EXPECT_FALSE(together.rests);
    EXPECT_GT(together.swing, 1e-3);
}

TEST(ContactRate, TheStiffestWallIsThatOfTheControlLoopAndNotOfContact) {
    const PlantParameters device = study::pressingDevice();
    for (const int ticks : {4, 16, 40}) {
        ApartOptions options{.controlTicks = ticks, .planes = true};
        options.spring.power = INFINITY;
        const double bound = study::stiffnessBound(device, kHz);
        options.stiffness = 0.95 * bound;
        EXPECT_TRUE(study::apartSettles(device, options, 2.0)) << kHz / ticks;
        options.stiffness = 1.1 * bound;
        EXPECT_FALSE(study::apartSettles(device, options, 2.0)) << kHz / ticks;
        EXPECT_LT(study::stiffestStable(device, kHz / ticks), 1.1 * bound / ticks);
    }
}

// A proxy that is a whole period late pulls along the surface to where the hand was: x'' = K/m (x(t - T) - x)
// is unstable where K T^2 is much above 2 m. Goals that give no energy are not.
TEST(ContactRate, LateGoalsThrowTheHandAlongTheSurfaceUnlessTheyGiveNoEnergy) {
    PlantParameters device = study::pressingDevice();
    device.viscousFriction = 0.5;
    ApartOptions late{.controlTicks = 40, .late = 40, .stiffness = 1800.0};
    late.spring.power = INFINITY;
    EXPECT_FALSE(study::apartSettles(device, late, 2.0));
    late.spring.power = 0.0;
    EXPECT_TRUE(study::apartSettles(device, late, 2.0));
}

TEST(ContactRate, LostGoalsAreStickyNotUnstable) {
    const PlantParameters device = study::pressingDevice();
    for (const double lost : {0.1, 0.5, 0.9}) {
        ApartOptions options{.controlTicks = 16, .late = 12, .lost = lost, .stiffness = 1800.0};
        EXPECT_TRUE(study::apartSettles(device, options, 2.0)) << lost;
    }
}

// Whatever is sent, a goal adds no more energy than the damper took and the power allows.
TEST(ContactRate, NoSequenceOfGoalsAddsEnergy) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const double bad[]{std::numeric_limits<double>::quiet_NaN(), INFINITY, -INFINITY, 1e300, -1e300};
    const auto any = [&](double scale) {
        return random() % 16 == 0 ? bad[random() % 5] : scale * unit(random);
    };
    const auto anyVector = [&](double scale) { return glm::dvec3(any(scale), any(scale), any(scale)); };
    for (const double power : {0.0, 0.2}) {
        ProxySpring spring({.power = power});
        glm::dvec3 hand(0.0), drift(0.0);
        double allowed = 0.0, refused = 0.0, heard = 0.0;
        for (int tick = 0; tick < 200'000; ++tick) {
            drift = 0.99 * drift + 1e-5 * glm::dvec3(unit(random), unit(random), unit(random));
            hand += drift;
            if (glm::length(hand) > 0.1)
                drift -= 1e-5 * hand;
            if (random() % 5 == 0 && tick % 4000 < 2500) { // and silences that fade it
                ContactGoal goal{.touching = random() % 8 != 0, .proxy = anyVector(0.2)};
                goal.stiffness = random() % 8 == 0 ? any(1e7) : std::pow(10.0, 2.0 + 2.0 * unit(random));
                goal.planeCount = static_cast<uint32_t>(random() % 5);
                for (glm::dvec3& plane : goal.planes)
                    plane = random() % 8 == 0 ? anyVector(1.0)
                                              : glm::normalize(glm::dvec3(unit(random), unit(random), 1.0));
                const bool taken = spring.hear(goal);
                EXPECT_EQ(taken, problemOf(goal) == nullptr);
                (taken ? heard : refused) += 1.0;
            }
            const double before = energyOf(spring, hand), given = spring.added();
            const DeviceCommand command = spring.step(at(hand), 1.0 / kHz, true);
            ASSERT_TRUE(std::isfinite(glm::length(command.force())));
            ASSERT_TRUE(std::isfinite(glm::length(spring.end())));
            allowed += power / kHz;
            // Without a damper there is no credit: what rose is what was counted.
            const double risen = energyOf(spring, hand) - before;
            ASSERT_LE(risen, spring.added() - given + 1e-12 * (1.0 + before));
            ASSERT_LE(spring.added(), allowed * (1.0 + 1e-9) + 1e-9); // rounding of the sums
        }
        EXPECT_GT(heard, 1000.0);
        EXPECT_GT(refused, 1000.0);
    }
}

// A hard spring that presses 1 mm against a weak device took 3 mJ, not the 5 J of K d^2 / 2: a soft one to a
// far place, heard next, has no more to give. Measured by the commands, also beside a damper that the device
// cannot exert.
TEST(ContactRate, WhatADeviceCannotPullIsNoEnergy) {
    for (const double damping : {0.0, 1e4}) {
        ProxySpring spring({.power = 0.0});
        DeviceSample sample = at({0.0, 0.0, 0.0});
        sample.limits.maxForce = 3.0;
        sample.limits.maxForceRate = 1e6;
        ContactGoal goal{.touching = true, .proxy = {0.0, 0.0, 0.0}, .stiffness = 1e7, .damping = damping};
        double given = 0.0, taken = 0.0;
        glm::dvec3 force(0.0);
        const auto move = [&](double y, bool tell) {
            given += force.y * (y - sample.position.y);
            sample.position.y = y;
            if (tell)
                (void)spring.hear(goal);
            force = spring.step(sample, 1.0 / kHz, true).force();
        };
        for (int tick = 0; tick < 4000; ++tick) // the force fades in
            move(0.0, true);
        for (int tick = 0; tick < 400; ++tick)
            move(-0.001 * tick / 400.0, true);
        taken = -given;
        EXPECT_GT(taken, 1e-3);
        goal = {.touching = true, .proxy = {0.0, 0.3, 0.0}, .stiffness = 100.0, .damping = damping};
        for (int tick = 0; tick < 40'000; ++tick)
            move(-0.001 + 0.3 * tick / 40'000.0, true);
        EXPECT_LT(given, 1e-4) << "damping " << damping;
    }
}

TEST(ContactRate, CommandsKeepTheLimitsOfTheDevice) {
    ProxySpring spring({.power = INFINITY});
    DeviceSample sample = sampleAt({0, -0.05, 0});
    double last = 0.0;
    bool reached = false;
    for (int tick = 0; tick < 4000; ++tick) {
        ASSERT_TRUE(spring.hear(wallAt(tick % 7 == 0 ? 100.0 : -100.0, 1e7)));
        const double force = spring.step(sample, 1.0 / kHz, true).force().y;
        EXPECT_LE(std::abs(force), sample.limits.maxForce);
        EXPECT_LE(std::abs(force - last), sample.limits.maxForceRate / kHz * (1.0 + 1e-9));
        reached |= std::abs(force) > 0.9 * sample.limits.maxForce;
        last = force;
    }
    EXPECT_TRUE(reached);
    // The key: no force, as fast as the slew limit goes.
    for (int tick = 0; tick < 8; ++tick)
        last = spring.step(sample, 1.0 / kHz, false).force().y;
    EXPECT_EQ(last, 0.0);
}

TEST(ContactRate, ASilentContactLetsTheHandGo) {
    ProxySpring spring({.power = INFINITY, .silence = 0.25});
    const auto force = [&](double seconds) {
        double now = 0.0;
        for (int tick = 0; tick < seconds * kHz; ++tick)
            now = spring.step(at({0, -0.002, 0}), 1.0 / kHz, true).force().y;
        return now;
    };
    ASSERT_TRUE(spring.hear(wallAt(0.0)));
    EXPECT_NEAR(force(0.2), 1.2, 1e-9);
    const double fading = force(0.075);
    EXPECT_GT(fading, 0.0);
    EXPECT_LT(fading, 1.2);
    EXPECT_EQ(force(0.1), 0.0);
    EXPECT_FALSE(spring.holds());
    // What comes back does not jump: it takes up the hand where it is.
    ASSERT_TRUE(spring.hear(wallAt(0.0)));
    EXPECT_LT(force(1.0 / kHz), 1.2 + 1e-9);
}

TEST(ContactRate, ThePlanesLetTheHandSlideAndTheProxyHoldsIt) {
    for (const bool planes : {false, true}) {
        ProxySpring spring({.power = INFINITY});
        ContactGoal goal = wallAt(0.0, 1000.0);
        goal.planes[0] = {0, 1, 0};
        goal.planeCount = planes ? 1 : 0;
        for (int tick = 0; tick < 800; ++tick) {
            ASSERT_TRUE(spring.hear(goal));
            (void)spring.step(at({0, -0.001, 0}), 1.0 / kHz, true);
        }
        (void)spring.step(at({0.002, -0.001, 0}), 1.0 / kHz, true);
        EXPECT_NEAR(spring.force().y, 1.0, 1e-9);
        EXPECT_NEAR(spring.force().x, planes ? 0.0 : -2.0, 1e-9);
        (void)spring.step(at({0.002, 0.001, 0}), 1.0 / kHz, true); // out of the wall
        EXPECT_NEAR(spring.force().y, planes ? 0.0 : -1.0, 1e-9);
    }
}

} // namespace touchstone::test
