// Convex features: needle tips, facets that are hardly apart, a cube's edge held and rocked.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kDegree = kPi / 180.0;

/// A needle along +y: a cone of 16 facets, 40 mm high, base radius 2 mm, tip at the origin.
assets::Shape needle() {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 16; ++i) {
        const double a = 2.0 * kPi * i / 16, b = 2.0 * kPi * (i + 1) / 16;
        const glm::dvec3 p(0.002 * std::cos(a), -0.04, 0.002 * std::sin(a)),
            q(0.002 * std::cos(b), -0.04, 0.002 * std::sin(b));
        corners.insert(corners.end(), {{0, 0, 0}, q, p, {0, -0.04, 0}, p, q});
    }
    return soup(corners);
}

TEST(Edges, ANeedleTipOnAndBesideItsAxis) {
    for (const double beside : {0.0, 20e-6})
        for (const Variant& v : allVariants())
            for (const double speed : allSpeeds()) {
                SCOPED_TRACE(std::to_string(beside * 1e6) + " um " + v.name() + " at " +
                             std::to_string(speed) + " m/s");
                TouchBench bench(sceneOf(needle()), v.settings());
                Gauge gauge;
                bench.step({beside, 0.02, 0.0});
                bench.moveTo({beside, -0.001, 0.0}, speed, [&](const HapticOutput& out) { gauge.take(out); });
                EXPECT_FALSE(has(bench.output.flags, TickFlag::StartedInside));
                // Never inside: the proxy keeps its radius from the axis below the tip.
                const glm::dvec3 p = bench.output.proxy;
                if (p.y < 0.0) {
                    EXPECT_GE(std::hypot(p.x, p.z), -p.y * 0.05 * std::cos(kPi / 16) * 0.99);
                }
                EXPECT_LT(holdStill(bench, 100), 1e-3);
                EXPECT_EQ(gauge.measured().notFinite, 0);
                // Slipping off the tip at depth d releases at most k d.
                EXPECT_LT(gauge.measured().largestJump, 1000.0 * (0.001 + v.radius + 1e-6));
            }
}

TEST(Edges, FacetsAQuarterDegreeApartNeverHoldThroughAMove) {
    // CHAI3D stuck for good in 17 to 26 of 40 such holds.
    for (const Variant& v : allVariants()) {
        int stuck = 0;
        for (int hold = 0; hold < 40; ++hold) {
            const double deviation = (0.25 + 0.5 * hold / 39.0) * kDegree;
            std::vector<glm::dvec3> corners; // a ridge of two facets
            const double drop = 0.05 * std::tan(0.5 * deviation);
            addQuad(corners, {-0.05, -drop, -0.05}, {-0.05, -drop, 0.05}, {0, 0, 0.05}, {0, 0, -0.05});
            addQuad(corners, {0, 0, -0.05}, {0, 0, 0.05}, {0.05, -drop, 0.05}, {0.05, -drop, -0.05});
            TouchBench bench(sceneOf(soup(corners)), v.settings());
            bench.step({-0.01, 0.01, 0.0});
            bench.moveTo({-0.01, -0.001, 0.0}, 0.05);
            bench.moveTo({0.0, -0.001, 0.0}, 0.05);
            EXPECT_LT(holdStill(bench, 50), 1e-9);
            bench.moveTo({0.004, -0.001, 0.0}, 0.05);
            // Over the edge the proxy stands within depth times the slope of the HIP.
            if (std::abs(bench.output.proxy.x - bench.output.hip.x) > 0.0015 * std::tan(deviation) + 1e-6)
                ++stuck;
        }
        EXPECT_EQ(stuck, 0) << v.name();
    }
}

TEST(Edges, ACubesEdgeHeldAndRockedIsQuiet) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        TouchBench bench(sceneOf(assets::box({0.1, 0.1, 0.1}, 3)), v.settings());
        Gauge gauge;
        const double depth = 0.002, theta = 0.5 * kPi;
        bench.step({0.06, 0.06, 0.003});
        bench.moveTo({0.049, 0.0495, 0.003}, 0.05);
        const auto take = [&](const HapticOutput& out) { gauge.take(out); };
        for (int rock = 0; rock < 20; ++rock) { // across the bisector and back
            bench.moveTo({0.05 - depth, 0.05 - 0.6 * depth, 0.003}, 0.02, take);
            bench.moveTo({0.05 - 0.6 * depth, 0.05 - depth, 0.003}, 0.02, take);
        }
        EXPECT_LT(holdStill(bench, 100), 1e-9);
        EXPECT_EQ(gauge.measured().notFinite, 0);
        // Crossing the bisector at depth d: the proxy goes round the edge, at most 2 d sin(theta / 2) in one
        // tick, and the hand must go back as far before it returns: energy of the hysteresis, bounded by k
        // d^2 a rock.
        EXPECT_LT(gauge.measured().largestJump,
                  1000.0 * 2.0 * (depth + v.radius) * std::sin(0.5 * theta) + 1e-3);
        EXPECT_LT(gauge.measured().energy, 1e-9) << "rocking creates no energy";
    }
}

} // namespace
} // namespace touchstone::test
