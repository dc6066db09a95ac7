// The momentum that bodies get is the impulse of the hands that push them.

#include "engine/core/float_mode.h"
#include "haptics/tick/stepped_hand.h"
#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

namespace touchstone::test {
namespace {

constexpr double kCubeSide = 0.04, kDt = 1e-3; // m, s
constexpr double kMost = 8.5;                  // N, what the device exerts

struct Balance {
    glm::dvec3 momentum{0.0}, impulse{0.0}; ///< N s
    double given = 0.0;                     ///< N s, sum of the sizes of the hands' impulses
    double most = 0.0;                      ///< N, the greatest sum of the hands' forces in a tick
    double spin = 0.0;                      ///< rad/s, the most
};

/// Hands at `starts` (m) move by `ways` within `seconds` and stay; the free cube is at the origin.
Balance pushed(double mass, const HapticSettings& settings, const std::vector<glm::dvec3>& starts,
               const std::vector<glm::dvec3>& ways, double seconds) {
    BodyMaker maker;
    (void)maker.surface(0.0, 0.0);
    (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, kCubeSide, mass);
    Bodies bodies(maker);
    SteppedWorld stepped(*bodies.haptic, bodies.scene);
    const size_t hands = starts.size();
    std::vector<DeviceSample> samples(hands);
    std::vector<DeviceState> states(hands);
    std::vector<HapticOutput> outputs(hands);
    NoStopwatch none;
    Balance balance;
    const body::BodyState& cube = stepped.world.bodies()->states()[0];
    for (int i = 0; i < 3000; ++i) {
        const double part = std::min(kDt * i / seconds, 1.0);
        for (size_t h = 0; h < hands; ++h)
            samples[h] = sampleAt(starts[h] + part * ways[h]);
        stepped.advance(kDt * i, settings);
        stepped.step(settings, samples, states, outputs, kDt, none);
        double sum = 0.0;
        for (const HapticOutput& output : outputs) {
            const double size = glm::length(output.force);
            const glm::dvec3 exerted = size > kMost ? kMost / size * output.force : output.force;
            balance.impulse -= kDt * exerted;
            balance.given += kDt * glm::length(exerted);
            sum += glm::length(exerted);
        }
        balance.most = std::max(balance.most, sum);
        balance.spin = std::max(balance.spin, glm::length(cube.spin));
    }
    balance.momentum = mass * cube.velocity;
    return balance;
}

/// One hand in the middle of a face, or two beside it, in free space without weight. What is pushed
/// implicitly takes the force at the end of each step, which the hand feels in the next: they differ by about
/// one step's force, whatever the way: also over 60 mm, most of them with the device at its greatest force
/// (failed: 1.4 to 1.8 % lost).
TEST(Momentum, IsTheImpulseOfOneHandAndOfTwo) {
    enterFloatMode();
    double worst = 0.0;
    for (const BodyIntegrator integrator :
         {BodyIntegrator::Explicit, BodyIntegrator::SemiImplicit, BodyIntegrator::Implicit})
        for (const double mass : {0.001, 0.01, 0.05, 0.1, 1.0, 10.0})
            for (const auto& [hands, way] : {std::pair{1, 0.03}, {2, 0.03}, {1, 0.06}}) {
                HapticSettings settings;
                settings.gravity = 0.0;
                settings.integrator = integrator;
                settings.stiffness = 1000.0;
                std::vector<glm::dvec3> starts{{-0.03, 0.0, 0.0}};
                if (hands == 2)
                    starts = {{-0.03, 0.008, 0.0}, {-0.03, -0.008, 0.0}};
                const Balance balance =
                    pushed(mass, settings, starts, {starts.size(), glm::dvec3(way, 0.0, 0.0)}, 0.1);
                const double part = glm::length(balance.momentum - balance.impulse) / balance.given;
                std::printf(
                    "%s, %g kg, %d hands, %g m: momentum %.7f N s, impulse %.7f N s, %.2g of it apart\n",
                    nameOf(integrator), mass, hands, way, balance.momentum.x, balance.impulse.x, part);
                EXPECT_GT(balance.momentum.x, 0.0);
                const bool atBeginning = integrator == BodyIntegrator::Explicit ||
                                         (integrator == BodyIntegrator::SemiImplicit && mass >= 0.01);
                const double steps = atBeginning ? 0.0 : 1.5;
                EXPECT_LE(glm::length(balance.momentum - balance.impulse),
                          steps * kDt * balance.most + 1e-4 * balance.given);
                EXPECT_LE(part, mass < 0.02 ? 0.5 : 0.016);
                worst = std::max(worst, part);
            }
    std::printf("worst: %.2g\n", worst);
}

/// Two hands meet at opposite faces, one above the centre and one below, and press.
TEST(Momentum, TwoHandsThatMeetOffTheCentreTurnABodyNoFasterThanTheirSpringsHold) {
    enterFloatMode();
    for (const BodyIntegrator integrator : {BodyIntegrator::SemiImplicit, BodyIntegrator::Implicit})
        for (const double mass : {0.001, 0.05, 1.0}) {
            HapticSettings settings;
            settings.gravity = 0.0;
            settings.integrator = integrator;
            settings.stiffness = 1000.0;
            const Balance balance = pushed(mass, settings, {{-0.03, 0.01, 0.0}, {0.03, -0.01, 0.0}},
                                           {glm::dvec3(0.015, 0.0, 0.0), glm::dvec3(-0.015, 0.0, 0.0)}, 0.3);
            // I w² / 2 is no more than the work of both devices at their greatest force over the way that
            // their springs can take: 5 mm each into the cube, and 20 mm more as it turns by half a right
            // angle.
            const double inertia = mass * kCubeSide * kCubeSide / 6.0;
            const double bound = std::sqrt(2.0 * 2.0 * kMost * 0.025 / inertia);
            std::printf("squeezed off its centre, %s, %g kg: spin at most %.2f rad/s of %.2f, momentum %.2g "
                        "of %.2g N s\n",
                        nameOf(integrator), mass, balance.spin, bound, glm::length(balance.momentum),
                        balance.given);
            EXPECT_LE(balance.spin, bound);
            EXPECT_NEAR(glm::length(balance.momentum - balance.impulse), 0.0, 1e-3 * balance.given);
        }
}

} // namespace
} // namespace touchstone::test
