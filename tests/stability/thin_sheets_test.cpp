// Nothing passes through a sheet: a plate of 1 mm pressed 3 mm deep, an open sheet from both sides, ten
// plates in a row, at every speed a hand and a fall can have.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

namespace touchstone::test {
namespace {

TEST(ThinSheets, APlateOfOneMillimetreHoldsAPressOfThree) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            TouchBench bench(sceneOf(assets::box({0.1, 0.001, 0.1}, 4)), v.settings());
            Gauge gauge;
            const auto take = [&](const HapticOutput& out) { gauge.take(out); };
            bench.step({0.013, 0.03, 0.007});
            bench.moveTo({0.013, -0.0025, 0.007}, speed, take);
            EXPECT_GE(bench.output.proxy.y, 0.0005)
                << "the proxy is above the plate though the HIP is below it";
            EXPECT_NEAR(bench.output.force.y, 1000.0 * (bench.output.proxy.y + 0.0025), 1e-6);
            // Stroke there, 3 mm deep under the surface, and come back up.
            bench.moveTo({-0.02, -0.0025, -0.03}, speed, take);
            EXPECT_GE(bench.output.proxy.y, 0.0005);
            bench.moveTo({-0.02, 0.03, -0.03}, speed, take);
            bench.moveTo({0.013, 0.03, 0.007}, speed, take);
            EXPECT_EQ(bench.output.contacts, 0u);
            EXPECT_EQ(gauge.measured().notFinite, 0);
            EXPECT_EQ(gauge.measured().budgetReached, 0);
            // A closed path over a flat plate creates no energy, but for the kink of the force inside the
            // tick in which contact begins or ends: the trapezium rule errs there by at most k (v dt)^2 / 8.
            const double stride = speed * 1e-3;
            EXPECT_LT(gauge.measured().energy, 2.0 * 1000.0 * stride * stride / 8.0 + 1e-9);
            EXPECT_LT(gauge.measured().largestJump, 1e-6);
        }
}

TEST(ThinSheets, AnOpenSheetHoldsFromBothSides) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds())
            for (const double side : {1.0, -1.0}) {
                SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s, side " +
                             std::to_string(side));
                TouchBench bench(sceneOf(assets::plane(0.1, 0.1, 5, 5)), v.settings());
                bench.step({0.0, side * 0.02, 0.0});
                bench.moveTo({0.01, -side * 0.004, 0.01}, speed);
                EXPECT_GT(side * bench.output.proxy.y, 0.0);
                EXPECT_GT(side * bench.output.force.y, 3.9);
                // Off the sheet's rim the hand is free; coming back under it, it is on the other side.
                bench.moveTo({0.08, -side * 0.004, 0.01}, speed);
                EXPECT_EQ(bench.output.contacts, 0u);
                bench.moveTo({0.01, -side * 0.004, 0.01}, speed);
                EXPECT_EQ(bench.output.contacts, 0u);
                bench.moveTo({0.01, side * 0.004, 0.01}, speed);
                EXPECT_LT(side * bench.output.proxy.y, 0.0);
                EXPECT_LT(side * bench.output.force.y, -3.9);
            }
}

TEST(ThinSheets, TheFirstOfTenPlatesInARowHolds) {
    assets::Shape plates;
    for (int i = 0; i < 10; ++i) {
        glm::dmat4 at(1.0);
        at[3] = glm::dvec4(0.0, -0.002 * i, 0.0, 1.0);
        append(plates, assets::box({0.1, 0.0005, 0.1}, 2), at);
    }
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            TouchBench bench(sceneOf(plates), v.settings());
            bench.step({0.011, 0.05, 0.007});
            bench.moveTo({0.011, -0.05, 0.007}, speed); // through all ten
            EXPECT_GT(bench.output.proxy.y, 0.00025);
            EXPECT_LT(holdStill(bench, 50), 1e-9);
            bench.moveTo({0.011, 0.05, 0.007}, speed);
            EXPECT_EQ(bench.output.contacts, 0u);
        }
}

TEST(ThinSheets, AHipThatTeleportsThroughEverythingIsHeldWhereItStarted) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        TouchBench bench(sceneOf(assets::box({0.1, 0.001, 0.1}, 4)), v.settings());
        bench.step({0.013, 0.03, 0.007});
        bench.step({0.013, -10.0, 0.007});
        EXPECT_GE(bench.output.proxy.y, 0.0005);
        EXPECT_TRUE(has(bench.output.flags, TickFlag::Teleported));
        bench.step({0.013, 100.0, 0.007});
        bench.step({0.013, 0.0, 0.007});
        EXPECT_GE(bench.output.proxy.y, 0.0005);
    }
}

} // namespace
} // namespace touchstone::test
