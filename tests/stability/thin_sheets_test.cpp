// Nothing passes through a sheet: a plate of 1 mm pressed 3 mm deep, an open sheet from both sides, ten
// plates in a row, at every speed a hand and a fall can have.

#include "tests/stability/hard_case.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test::thin_sheets_test {
namespace {

/// How far `p` is outside of a box about `centre`, m; negative inside.
double outsideBox(const glm::dvec3& p, const glm::dvec3& centre, const glm::dvec3& half) {
    const glm::dvec3 out = glm::abs(p - centre) - half;
    return std::max({out.x, out.y, out.z});
}

TEST(ThinSheets, APlateOfOneMillimetreHoldsAPressOfThree) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            HardCase run("plate 1 mm, pressed 3 mm", sceneFor(assets::box({0.1, 0.001, 0.1}, 4), v), v);
            // Above it all along: below would be out of the box too.
            run.side([](const glm::dvec3& p) { return p.y - 0.0005; });
            run.startAt({0.013, 0.03, 0.007});
            run.moveTo({0.013, -0.0025, 0.007}, speed);
            run.hold();
            if (!v.shaded) {
                EXPECT_NEAR(run.bench.output.force.y, 1000.0 * (run.bench.output.proxy.y + 0.0025), 1e-6);
            }
            run.moveTo({-0.02, -0.0025, -0.03}, speed); // a stroke there, 3 mm under the surface
            run.hold();
            run.moveTo({-0.02, 0.03, -0.03}, speed);
            run.leave(speed);
        }
}

TEST(ThinSheets, AnOpenSheetHoldsFromBothSides) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds())
            for (const double side : {1.0, -1.0}) {
                SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s, side " +
                             std::to_string(side));
                HardCase run("open sheet, both sides", sceneFor(assets::plane(0.1, 0.1, 5, 5), v), v);
                // It may change sides only beside the sheet.
                bool above = true;
                run.side([&above, side](const glm::dvec3& p) {
                    const bool over = std::max(std::abs(p.x), std::abs(p.z)) < 0.05;
                    if (!over)
                        above = side * p.y > 0.0;
                    return over ? (above ? side : -side) * p.y : 0.0;
                });
                run.startAt({0.0, side * 0.02, 0.0});
                run.moveTo({0.01, -side * 0.004, 0.01}, speed);
                EXPECT_GT(side * run.bench.output.force.y, 3.9);
                run.hold();
                // Off the sheet's rim the hand is free; coming back under it, it is on the other side.
                run.moveTo({0.08, -side * 0.004, 0.01}, speed);
                EXPECT_EQ(run.bench.output.contacts, 0u);
                run.moveTo({0.01, -side * 0.004, 0.01}, speed);
                EXPECT_EQ(run.bench.output.contacts, 0u);
                run.moveTo({0.01, side * 0.004, 0.01}, speed);
                EXPECT_LT(side * run.bench.output.force.y, -3.9);
                run.hold();
                run.moveTo({0.01, -side * 0.004, 0.01}, speed);
                run.moveTo({0.08, -side * 0.004, 0.01}, speed);
                run.moveTo({0.08, side * 0.02, 0.01}, speed);
                run.moveTo({0.0, side * 0.02, 0.0}, speed);
                run.judge();
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
            HardCase run("ten plates in a row", sceneFor(plates, v), v);
            run.side([](const glm::dvec3& p) { return p.y - 0.00025; });
            run.startAt({0.011, 0.05, 0.007});
            run.moveTo({0.011, -0.05, 0.007}, speed); // through all ten
            run.hold();
            run.leave(speed);
        }
}

TEST(ThinSheets, AHipThatTeleportsThroughEverythingIsHeldWhereItStarted) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        HardCase run("HIP teleports", sceneFor(assets::box({0.1, 0.001, 0.1}, 4), v), v);
        const glm::dvec3 half(0.05, 0.0005, 0.05);
        run.side([half](const glm::dvec3& p) { return outsideBox(p, glm::dvec3(0.0), half); });
        run.startAt({0.013, 0.03, 0.007});
        run.teleportTo({0.013, -3.0, 0.007});
        EXPECT_GT(run.bench.output.proxy.y, 0.0005);
        EXPECT_TRUE(has(run.bench.output.flags, TickFlag::Teleported));
        run.hold();
        run.teleportTo({0.013, 5.0, 0.007});
        EXPECT_EQ(run.bench.output.contacts, 0u);
        run.teleportTo({0.013, 0.0, 0.007});
        EXPECT_GT(run.bench.output.proxy.y, 0.0005);
        run.teleportTo({-3.0, -1.0, 2.0}); // slides off the rim, and from there it is free
        EXPECT_EQ(run.bench.output.contacts, 0u);
        run.teleportTo({0.013, 0.0, 0.007});
        EXPECT_LT(run.bench.output.proxy.y, -0.0005) << "from below it is held below";
        run.hold();
        run.teleportTo({0.3, 0.0, 0.007});
        run.teleportTo({0.013, 0.03, 0.007});
        run.judge();
    }
}

} // namespace
} // namespace touchstone::test::thin_sheets_test
