// With wall damping: Colgate and Schenkel's b > K T / 2 + |B|, as passivity in the frequency domain, and what
// hands make of it. The condition is for a device of any mass in any passive hand, so no mass, spring and
// damper may be unstable above it; and below it some are.

#include "haptics/sample/hip_sample.h"
#include "tests/stability/closed_loop/loop_bench.h"
#include "tests/stability/closed_loop/sampled_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

namespace touchstone::test {
namespace {

struct Wall {
    double stiffness, damping;
};

/// The least viscosity that makes a device passive against a wall of this loop.
double minViscosity(const LinearLoop& loop, const Wall& wall) {
    return passiveViscosity(
        [&](std::complex<double> z) { return wallOf(loop, wall.stiffness, wall.damping, z); }, loop.period);
}

/// Hands from none to a heavy arm, from limp to a vice, with losses and without; and springs that tune the
/// whole to any frequency the servo can see.
std::vector<LinearLoop> manyHands(const LinearLoop& device) {
    std::vector<LinearLoop> hands;
    for (const double mass : {0.0, 0.003, 0.02, 0.1, 0.5, 3.0})
        for (const double damping : {0.0, 0.03, 0.3, 3.0, 30.0}) {
            LinearLoop hand = device;
            hand.handMass = mass;
            hand.handDamping = damping;
            hands.push_back(hand);
            for (const double stiffness : {1.0, 30.0, 1e3, 3e4})
                hands.emplace_back(hand).handStiffness = stiffness;
            for (double share = 0.05; share < 1.0; share += 0.05) {
                const double omega = share * std::numbers::pi / device.period;
                hands.emplace_back(hand).handStiffness = (device.mass + mass) * omega * omega;
            }
        }
    return hands;
}

double worstRadius(const LinearLoop& device, const Wall& wall, LinearLoop& worst) {
    double most = 0.0;
    for (const LinearLoop& hand : manyHands(device)) {
        const double radius = spectralRadius(hand, wall.stiffness, wall.damping);
        if (radius > most) {
            most = radius;
            worst = hand;
        }
    }
    return most;
}

TEST(PassiveHands, ColgatesConditionIsTheFrequencyDomainsForEveryWall) {
    for (const double period : {1e-3, 2.5e-4})
        for (const Wall& wall : {Wall{1000, 0}, Wall{500, 2}, Wall{2000, 0.7}, Wall{300, -0.4}, Wall{0, 5}}) {
            const LinearLoop loop{.period = period};
            EXPECT_NEAR(minViscosity(loop, wall) / (0.5 * wall.stiffness * period + std::abs(wall.damping)),
                        1.0, 1e-6)
                << wall.stiffness << " N/m, " << wall.damping << " N s/m";
        }
}

TEST(PassiveHands, ATickOfDelayTriplesWhatASpringDemands) {
    // Re{(1 - 1/z) K / z} T / (2 (1 - cos)) = K T / 2 (2 cos wT + 1), largest at low frequency.
    EXPECT_NEAR(minViscosity({.delay = 1}, {1000, 0}), 1.5, 1e-6);
}

TEST(PassiveHands, AFilteredVelocityDemandsLess) {
    // The low-pass of the tick takes the edge off B at pi / T, by s / (2 - s).
    const double share = -std::expm1(-2.0 * std::numbers::pi * kVelocityCutoff * 1e-3);
    const LinearLoop loop{.velocityCutoff = kVelocityCutoff};
    const double damping = 3.0;
    const double top = damping * share / (2.0 - share), least = minViscosity(loop, {0, damping});
    EXPECT_GE(least, top * (1.0 - 1e-9));
    EXPECT_LT(least, damping);
    std::cout << "  B " << damping << " through " << kVelocityCutoff << " Hz demands b " << least
              << ", at pi/T alone " << top << "\n";
}

TEST(PassiveHands, NoneGoesUnstableAboveTheConditionAndSomeDoBelowIt) {
    for (const double cutoff : {0.0, kVelocityCutoff})
        for (const int delay : {0, 1})
            for (const double mass : {0.01, 0.075})
                for (const Wall& wall : {Wall{1000, 0}, Wall{1000, 0.5}, Wall{200, 2}, Wall{3000, 1}}) {
                    LinearLoop device{.mass = mass, .delay = delay, .velocityCutoff = cutoff};
                    const double least = minViscosity(device, wall);
                    LinearLoop worst;
                    device.viscous = 1.001 * least;
                    EXPECT_LT(worstRadius(device, wall, worst), 1.0)
                        << "hand of " << worst.handMass << " kg, " << worst.handDamping << " N s/m, "
                        << worst.handStiffness << " N/m";
                    // How far below it the first of these hands is unstable.
                    double low = 0.0, high = 1.0;
                    for (int step = 0; step < 12; ++step) {
                        const double middle = 0.5 * (low + high);
                        device.viscous = middle * least;
                        (worstRadius(device, wall, worst) < 1.0 ? high : low) = middle;
                    }
                    EXPECT_GT(high, 0.25) << "the sweep is too mild to mean anything";
                    std::cout << "  " << mass << " kg, K " << wall.stiffness << ", B " << wall.damping
                              << ", cut-off " << cutoff << " Hz, delay " << delay << ": b > " << least
                              << ", first unstable hand at " << high << " of it\n";
                }
}

TEST(PassiveHands, TheWholeStepIsStableInThemToo) {
    // The same through contact, force and safety: above the condition every swing dies, in every hand of
    // these.
    for (const Wall& wall : {Wall{1000, 0}, Wall{1000, 0.5}, Wall{200, 2}, Wall{3000, 1}}) {
        const LinearLoop device{.mass = 0.075, .velocityCutoff = kVelocityCutoff};
        const double viscous = 1.02 * minViscosity(device, wall);
        int hands = 0;
        for (const double mass : {0.0, 0.02, 0.5})
            for (const double damping : {0.0, 0.3, 10.0})
                for (const double stiffness : {0.0, 100.0, 3000.0, 7.4e4, 7.4e5}) {
                    PlantParameters plant = bareDevice(0.075, viscous);
                    plant.handMass = mass;
                    plant.handDamping = damping;
                    plant.handStiffness = stiffness;
                    EXPECT_TRUE(
                        pressedWallSettles(plant, plainWall(wall.stiffness, wall.damping), 1000.0, 8000))
                        << "K " << wall.stiffness << ", B " << wall.damping << ", hand of " << mass << " kg, "
                        << damping << " N s/m, " << stiffness << " N/m";
                    ++hands;
                }
        EXPECT_EQ(hands, 45);
        const bool below = pressedWallSettles(bareDevice(0.075, 0.97 / 1.02 * viscous),
                                              plainWall(wall.stiffness), 1000.0, 20000);
        EXPECT_TRUE(wall.damping > 0.0 || !below)
            << "a bare mass and a spring is where the condition is sharp";
    }
}

} // namespace
} // namespace touchstone::test
