// With Coulomb friction and a sensor with steps: Abbott and Okamura (IEEE T-RO 21(5), 2005) bound the wall
// that is passive, and stable in every passive hand, by K <= min(2 b / T, 2 fc / step). The first is the
// sampled spring's; the second says that friction must be able to hold either of two neighbouring steps of
// force, K step apart.
//
// Stable here means: after a tap, a press or a release the device comes to rest to the bit and stays there.

#include "tests/stability/closed_loop/loop_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

namespace touchstone::test {
namespace {

struct Device {
    const char* name;
    double mass, viscous, coulomb, step, rate;
    [[nodiscard]] double bound() const { return std::min(2.0 * viscous * rate, 2.0 * coulomb / step); }
};

struct Grip {
    double mass, damping, stiffness;
};
/// None (a weight presses), light, limp and heavy, stiff without losses.
constexpr Grip kGrips[]{{0, 0, 0}, {0.02, 3, 300}, {0.3, 0.5, 40}, {0.05, 0, 3000}};

/// True if the device comes to rest in that hand within `seconds`.
bool rests(const Device& device, const Grip& grip, const Start& start, double stiffness, double seconds) {
    PlantParameters plant = bareDevice(device.mass, device.viscous);
    plant.coulombFriction = device.coulomb;
    plant.resolution = device.step;
    plant.handMass = grip.mass;
    plant.handDamping = grip.damping;
    plant.handStiffness = grip.stiffness;
    return meetWall(plant, plainWall(stiffness), device.rate, start, seconds).rests;
}

bool alwaysRests(const Device& device, double stiffness, double seconds) {
    for (const Grip& grip : kGrips)
        for (const Start& start : kWallStarts)
            if (!rests(device, grip, start, stiffness, seconds))
                return false;
    return true;
}

const Device kDevices[]{
    {"both bounds near", 0.075, 1.0, 0.04, 3e-5, 1000},
    {"steps bind", 0.075, 1.0, 0.04, 1e-4, 1000},
    {"sampling binds", 0.075, 0.5, 0.02, 1e-5, 1000},
    {"coarse sensor", 0.1, 5.0, 0.05, 3e-4, 1000},
    {"4 kHz", 0.05, 0.5, 0.04, 5e-5, 4000},
    {"500 Hz", 0.1, 1.0, 0.1, 2e-4, 500},
    {"viscous Phantom", 0.075, 0.1, 0.04, 3e-5, 1000},
};

TEST(FrictionAndSteps, NothingIsUnstableBelowAbbottAndOkamurasBound) {
    for (const Device& device : kDevices)
        for (const double share : {0.1, 0.3, 0.6, 0.9, 0.999})
            for (const Grip& grip : kGrips)
                for (const Start& start : kWallStarts)
                    EXPECT_TRUE(rests(device, grip, start, share * device.bound(), 120.0))
                        << device.name << ", " << share << " of the bound, hand of " << grip.stiffness
                        << " N/m, from " << start.height << " m at " << start.speed << " m/s";
}

/// Up in steps of 10 % from the bound until something does not come to rest.
double measuredLimit(const Device& device) {
    double stiffness = device.bound();
    while (stiffness < 1e6 && alwaysRests(device, 1.1 * stiffness, 120.0))
        stiffness *= 1.1;
    return stiffness;
}

TEST(FrictionAndSteps, BeyondTheBoundSomethingIs) {
    double least = 1e9;
    for (const Device& device : kDevices) {
        const double limit = measuredLimit(device), ratio = limit / device.bound();
        EXPECT_LT(limit, 1e6) << device.name << ": the hands are too mild to mean anything";
        EXPECT_GE(ratio, 1.0);
        least = std::min(least, ratio);
        std::cout << "  " << device.name << ": bound " << device.bound() << " N/m, everything rests up to "
                  << limit << ", ratio " << ratio << "\n";
    }
    EXPECT_LT(least, 4.0) << "the bound is far from what is measured everywhere";
}

TEST(FrictionAndSteps, APhantomBearsMoreThanItsViscosityAlone) {
    // Almost all that takes energy in it is Coulomb friction, which the bound does not count on for sampling
    // (Diolaiti et al. 2006): stable in these hands far above 2 b / T.
    const PlantParameters phantom;
    const Device device{"Phantom Premium 1.5",   phantom.mass,       phantom.viscousFriction,
                        phantom.coulombFriction, phantom.resolution, 1000};
    const double limit = measuredLimit(device);
    EXPECT_GE(limit, device.bound());
    std::cout << "  " << device.name << ": bound " << device.bound() << " N/m, everything rests up to "
              << limit << ", ratio " << limit / device.bound() << "\n";
    const auto inALightGrip = [&](double stiffness) {
        for (const Start& start : kWallStarts)
            if (!rests(device, kGrips[1], start, stiffness, 20.0))
                return false;
        return true;
    };
    double held = 500.0;
    EXPECT_TRUE(inALightGrip(held));
    while (held < 1e6 && inALightGrip(1.05 * held))
        held *= 1.05;
    std::cout << "  in a light grip alone: up to " << held << " N/m\n";
    EXPECT_LT(held, 1e6);
}

/// A device of 75 g that a weight presses 1 mm into a plane and pulls sideways with `pull` N, pushed off at
/// `speed` m/s: its speed after `seconds`.
double speedOfPulled(FrictionMode law, double pull, double speed, double seconds) {
    HapticSettings settings = plainWall(600.0);
    settings.friction = law;
    settings.staticFriction = settings.dynamicFriction = 0.5; // 0.3 N
    settings.frictionThreshold = 0.01;
    settings.frictionViscosity = 2.0;
    LoopBench loop(sceneOf(assets::plane(2.0, 2.0)), settings, bareDevice(0.075, 1.0), 1000.0);
    loop.weight = {pull, -0.6, 0.0};
    const glm::dvec3 rest{-0.5, -1e-3, 0.017};
    loop.intention = [rest](double) { return rest; };
    loop.hold(rest + glm::dvec3(0, 2e-3, 0), rest);
    loop.release(rest, {speed, 0, 0});
    for (int i = 0; i < 1000.0 * seconds; ++i)
        (void)loop.tick();
    return loop.plant().velocity().x;
}

TEST(FrictionAndSteps, AVelocityThresholdCannotHoldWhatSlides) {
    // [001 §4.1]: "a user should be able to support an object using only the friction force without the
    // object slipping"; a viscous one supports it at no speed but pull / (b + device's own), here 3 N s/m.
    // The limits of friction are 0.3 N.
    for (const double pull : {0.06, 0.15, 0.24}) {
        EXPECT_NEAR(speedOfPulled(FrictionMode::VelocityThreshold, pull, 0.1, 3.0), pull / 3.0, 1e-4) << pull;
        EXPECT_NEAR(speedOfPulled(FrictionMode::Zilles, pull, 0.1, 3.0), 0.0, 1e-6) << pull;
        // Pulled all at once the spring stretches to twice its rest, which is to stay below the limit.
        if (2.0 * pull <= 0.3) {
            EXPECT_NEAR(speedOfPulled(FrictionMode::VelocityThreshold, pull, 0.0, 3.0), 0.0, 1e-6)
                << "what never broke away is held";
        }
    }
    // Slower than the threshold it sticks after all.
    EXPECT_NEAR(speedOfPulled(FrictionMode::VelocityThreshold, 0.02, 0.1, 3.0), 0.0, 1e-6);
}

} // namespace
} // namespace touchstone::test
