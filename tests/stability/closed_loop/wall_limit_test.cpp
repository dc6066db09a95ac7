// The largest stable wall of a bare mass and damper: measured through the whole haptic step, against the
// exact eigenvalues and against 2 b / T.
//
// 2 b / T is where device and wall stop being passive together (Colgate and Schenkel), whatever the mass.
// Where the bare loop becomes unstable it is the limit of the exact condition (1 - a) / c for a = exp(-bT/m)
// near 1: 2 b / T (1 + bT/(6m) + ...). So "within 5 %" holds where bT/m is below 0.27: for every device that
// is light to move, whose velocity hardly decays within a tick. Heavier damped ones bear more (1.4 times as
// much at the most), until one without mass is back at 2 b / T by way of alternating signs.

#include "haptics/sample/hip_sample.h"
#include "tests/stability/closed_loop/loop_bench.h"
#include "tests/stability/closed_loop/sampled_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace touchstone::test {
namespace {

struct Bare {
    double mass, viscous, rate;
    [[nodiscard]] double decay() const { return viscous / (rate * mass); } ///< b T / m
};

double measuredLimit(const Bare& device, int delay) {
    PlantParameters plant = bareDevice(device.mass, device.viscous);
    plant.delay = delay;
    const double guess = bareLimit(device.mass, device.viscous, 1.0 / device.rate, delay);
    const auto stable = [&](double stiffness) {
        return pressedWallSettles(plant, plainWall(stiffness), device.rate, 20000);
    };
    EXPECT_TRUE(stable(0.5 * guess)) << "half the expected limit";
    EXPECT_FALSE(stable(2.0 * guess)) << "twice the expected limit";
    return largestStable(0.5 * guess, 2.0 * guess, stable);
}

TEST(SampledWall, TheClosedFormIsWhereTheEigenvaluesAre) {
    for (const double mass : {0.002, 0.05, 0.5})
        for (const double viscous : {0.1, 2.0, 30.0})
            for (const double period : {1e-3, 2.5e-4})
                for (const int delay : {0, 1}) {
                    const LinearLoop loop{.mass = mass, .viscous = viscous, .period = period, .delay = delay};
                    const double limit = bareLimit(mass, viscous, period, delay);
                    EXPECT_NEAR(eigenvalueLimit(loop) / limit, 1.0, 1e-6)
                        << mass << " kg, " << viscous << " N s/m, " << period << " s, delay " << delay;
                }
}

TEST(SampledWall, WithoutDelayTheLimitIsTwoBOverT) {
    for (const Bare& device : {Bare{0.1, 2.0, 1000}, Bare{0.075, 0.5, 1000}, Bare{0.05, 5.0, 500},
                               Bare{0.2, 1.0, 4000}, Bare{0.1, 10.0, 1000}, Bare{0.1, 25.0, 1000}}) {
        ASSERT_LT(device.decay(), 0.27);
        const double limit = measuredLimit(device, 0), simple = 2.0 * device.viscous * device.rate;
        EXPECT_NEAR(limit / simple, 1.0, 0.05);
        EXPECT_NEAR(limit / bareLimit(device.mass, device.viscous, 1.0 / device.rate, 0), 1.0, 1e-3);
        std::cout << "  bT/m " << device.decay() << ": " << limit << " N/m, " << limit / simple
                  << " of 2b/T\n";
    }
}

TEST(SampledWall, OfWhateverMassTheExactLimitHolds) {
    double most = 0.0;
    for (const Bare& device : {Bare{0.02, 20, 1000}, Bare{0.005, 10, 1000}, Bare{0.005, 20, 1000},
                               Bare{0.002, 20, 1000}, Bare{0.001, 30, 1000}}) {
        const double limit = measuredLimit(device, 0), simple = 2.0 * device.viscous * device.rate;
        EXPECT_NEAR(limit / bareLimit(device.mass, device.viscous, 1.0 / device.rate, 0), 1.0, 1e-3);
        EXPECT_GT(limit / simple, 1.0) << "2b/T is always safe";
        most = std::max(most, limit / simple);
        std::cout << "  bT/m " << device.decay() << ": " << limit / simple << " of 2b/T\n";
    }
    EXPECT_GT(most, 1.9) << "and not sharp in between";
}

TEST(SampledWall, WithATickOfDelayTheLimitIsTheExactOne) {
    for (const Bare& device : {Bare{0.1, 2.0, 1000}, Bare{0.075, 0.5, 1000}, Bare{0.05, 5.0, 500},
                               Bare{0.2, 1.0, 4000}, Bare{0.02, 20, 1000}, Bare{0.005, 20, 1000}}) {
        const double limit = measuredLimit(device, 1);
        const double exact = bareLimit(device.mass, device.viscous, 1.0 / device.rate, 1);
        EXPECT_NEAR(limit / exact, 1.0, 0.01);
        std::cout << "  bT/m " << device.decay() << ": " << limit << " N/m, " << limit / exact
                  << " of the exact limit, " << limit / (2.0 * device.viscous * device.rate) << " of 2b/T\n";
    }
}

TEST(SampledWall, AHandAndTheWallsDampingMoveTheLimitAsTheEigenvaluesSay) {
    // The wall's damping takes the filtered velocity of the step.
    struct Held {
        double handMass, handDamping, handStiffness, wallDamping;
    };
    for (const Held& held : {Held{0.0, 0.0, 0.0, 1.0}, Held{0.05, 1.0, 200.0, 0.0},
                             Held{0.02, 3.0, 300.0, 2.0}, Held{0.2, 0.2, 2000.0, 5.0}})
        for (const int delay : {0, 1}) {
            PlantParameters plant = bareDevice(0.075, 0.5);
            plant.handMass = held.handMass;
            plant.handDamping = held.handDamping;
            plant.handStiffness = held.handStiffness;
            plant.delay = delay;
            const LinearLoop loop{.mass = 0.075,
                                  .viscous = 0.5,
                                  .handMass = held.handMass,
                                  .handDamping = held.handDamping,
                                  .handStiffness = held.handStiffness,
                                  .delay = delay,
                                  .velocityCutoff = kVelocityCutoff};
            const double exact = eigenvalueLimit(loop, held.wallDamping);
            ASSERT_GT(exact, 10.0);
            const double limit = largestStable(0.5 * exact, 1.5 * exact, [&](double stiffness) {
                return pressedWallSettles(plant, plainWall(stiffness, held.wallDamping), 1000.0, 20000);
            });
            EXPECT_NEAR(limit / exact, 1.0, 0.01) << "delay " << delay << ", B " << held.wallDamping;
            std::cout << "  B " << held.wallDamping << ", hand " << held.handStiffness << " N/m, delay "
                      << delay << ": " << limit << " N/m, " << limit / exact << " of the eigenvalue limit\n";
        }
}

} // namespace
} // namespace touchstone::test
