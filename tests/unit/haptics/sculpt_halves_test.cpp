// Dabs in two halves: their shape, and the distances around it.

#include "haptics/shape/field/sculpt/sculptor.h"
#include "tests/support/field_nodes.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace touchstone::test::sculpt_halves_test {
namespace {

/// A ball that is taken out or joined, in two halves: the second gives the bytes of the whole dab; after the
/// first the surface and the exact side are final, and no distance on the other side is too long.
TEST(SculptHalves, AShapeAndItsRestorationAreTheDab) {
    for (const SculptTool tool : {SculptTool::Carve, SculptTool::Add}) {
        const auto base = gridOf(block, 96);
        const double voxel = base->layout().voxel;
        const Dab dab{.tool = tool, .centre = {0.39, 0.05, -0.1}, .radius = 0.11};
        Sculptor whole(base), halves(base);
        const DabReport once = whole.apply(dab);
        EXPECT_FALSE(halves.owesDistances());
        const DabReport first = halves.shape(dab);
        EXPECT_TRUE(halves.owesDistances());
        EXPECT_NEAR(first.removed, once.removed, 0.01 * std::abs(once.removed));
        const std::vector<float> done = allNodes(*whole.grid()), shaped = allNodes(*halves.grid());
        size_t bounds = 0;
        for (size_t i = 0; i < done.size(); ++i) {
            const bool exact = (done[i] < 0.0f) == (tool == SculptTool::Carve);
            ASSERT_EQ(done[i] < 0.0f, shaped[i] < 0.0f) << "the surface is where it will be";
            if (exact) {
                ASSERT_EQ(shaped[i], done[i]);
            } else if (const double far = std::abs(done[i]);
                       far < 0.9 * base->outside()) { // the field's reach
                ASSERT_LE(std::abs(shaped[i]), far + 0.03 * voxel);
                bounds += shaped[i] != done[i] ? 1 : 0;
            }
        }
        EXPECT_GT(bounds, 100u);
        halves.restore();
        EXPECT_FALSE(halves.owesDistances());
        EXPECT_EQ(halves.grid()->hash(), whole.grid()->hash());
        EXPECT_EQ(allNodes(*halves.grid()), done);
        EXPECT_EQ(halves.restore().bricks, 0u);
        // Both halves are one step.
        EXPECT_TRUE(halves.undo());
        EXPECT_EQ(halves.grid().get(), base.get());
    }
}

/// Three balls with one restoration: inside the distance that is known, and outside nearer to it than three
/// dabs, whose restorations build on each other (0.28 and 0.37 voxels at the worst nodes, by samples of the
/// surface).
TEST(SculptHalves, ShapesNearEachOtherAreRestoredTogether) {
    const auto base = gridOf(block, 96);
    const double voxel = base->layout().voxel, radius = 0.08;
    std::vector<Dab> dabs;
    for (int i = 0; i < 3; ++i)
        dabs.push_back({.centre = {0.4, 0.25 * radius * i, 0.03}, .radius = radius});
    Sculptor together(base), apart(base);
    EXPECT_FALSE(together.joins(dabs[0])) << "nothing to join";
    for (const Dab& dab : dabs) {
        together.shape(dab);
        EXPECT_TRUE(together.joins(dab));
        apart.apply(dab);
    }
    EXPECT_FALSE(together.joins({.tool = SculptTool::Add, .centre = dabs[1].centre, .radius = radius}));
    EXPECT_FALSE(together.joins({.tool = SculptTool::Smooth, .centre = dabs[1].centre, .radius = radius}));
    EXPECT_FALSE(together.joins({.centre = {-0.4, 0.0, 0.0}, .radius = radius})) << "too far";
    together.restore();
    const std::vector<float> a = allNodes(*together.grid()), b = allNodes(*apart.grid());
    double worst = 0.0, inside = 0.0;
    size_t i = 0;
    for (int z = 0; z <= 96; ++z)
        for (int y = 0; y <= 96; ++y)
            for (int x = 0; x <= 96; ++x, ++i) {
                worst = std::max(worst, std::abs(static_cast<double>(a[i] - b[i])) / voxel);
                if (a[i] >= 0.0f)
                    continue;
                const glm::dvec3 p = base->layout().origin + voxel * glm::dvec3(x, y, z);
                double truth = block(p);
                for (const Dab& dab : dabs)
                    truth = std::max(truth, radius - glm::distance(p, dab.centre));
                inside = std::max(
                    inside, std::abs(static_cast<double>(a[i]) - std::max(truth, -base->inside())) / voxel);
            }
    std::printf("three shapes: %.4f voxels off three dabs, %.5f off the distance inside\n", worst, inside);
    EXPECT_LT(worst, 0.25);
    EXPECT_LT(inside, 0.001);
}

/// Whatever comes between the halves, the field repeats to the last bit and goes back to the bytes.
TEST(SculptHalves, ShapesMayBeLeftToAnyOtherChange) {
    const auto base = gridOf(ball, 64);
    const std::vector<float> original = allNodes(*base);
    const auto sculpt = [&](Sculptor& sculptor) {
        std::mt19937 random(3);
        for (int i = 0; i < 120; ++i) {
            const auto number = [&](double low, double high) {
                return std::uniform_real_distribution<double>(low, high)(random);
            };
            Dab dab;
            dab.tool = std::array{SculptTool::Carve, SculptTool::Add, SculptTool::Smooth,
                                  SculptTool::Drag}[random() % 4];
            dab.centre = {number(-0.5, 0.5), number(-0.5, 0.5), number(-0.5, 0.5)};
            dab.motion = {number(-0.05, 0.05), number(-0.05, 0.05), number(-0.05, 0.05)};
            dab.radius = number(0.03, 0.13);
            switch (random() % 8) {
            case 0:
                sculptor.undo();
                break;
            case 1:
                sculptor.redo();
                break;
            case 2:
                sculptor.beginStroke();
                break;
            case 3:
                sculptor.restore();
                break;
            case 4:
                sculptor.apply(dab);
                break;
            default: // of other tools it is the whole dab
                dab.tool = random() % 3 == 0 ? dab.tool : i % 20 < 10 ? SculptTool::Carve : SculptTool::Add;
                dab.strength = 1.0;
                dab.falloff = 0.0;
                sculptor.shape(dab);
            }
        }
        sculptor.restore();
    };
    Sculptor one(base), other(base);
    sculpt(one);
    sculpt(other);
    EXPECT_EQ(one.grid()->hash(), other.grid()->hash());
    EXPECT_NE(one.grid()->hash(), base->hash());
    EXPECT_LT(one.grid()->lipschitz(), 2.5);
    while (one.undo()) {
    }
    EXPECT_EQ(allNodes(*one.grid()), original);
}

} // namespace
} // namespace touchstone::test::sculpt_halves_test
