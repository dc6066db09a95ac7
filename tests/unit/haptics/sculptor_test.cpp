// Sculpted fields against closed forms, and what undo and determinism promise.

#include "engine/core/error.h"
#include "haptics/shape/field/sculpt/node_queue.h"
#include "haptics/shape/field/sculpt/sculptor.h"
#include "tests/support/field_nodes.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <queue>
#include <random>
#include <utility>
#include <vector>

namespace touchstone::test::sculptor_test {
namespace {

struct Worst {
    double distance = 0.0; ///< voxels, |f - truth| at nodes
    double slope = 0.0;    ///< ||grad f| - 1|
    double meanSlope = 0.0;
};

/// At nodes within `band` voxels of the surface where `smooth` holds three voxels around.
Worst compare(const FieldGrid& grid, const Distance& truth, double band,
              const std::function<bool(const glm::dvec3&)>& smooth) {
    Worst worst;
    const FieldLayout& layout = grid.layout();
    int count = 0;
    for (int z = 1; z < layout.cells.z; ++z)
        for (int y = 1; y < layout.cells.y; ++y)
            for (int x = 1; x < layout.cells.x; ++x) {
                const glm::dvec3 p = layout.origin + layout.voxel * glm::dvec3(x, y, z);
                const double d = truth(p);
                if (std::abs(d) > band * layout.voxel || !smooth(p))
                    continue;
                worst.distance = std::max(worst.distance, std::abs(grid.node({x, y, z}) - d) / layout.voxel);
                const double off = std::abs(glm::length(grid.nodeGradient({x, y, z})) - 1.0);
                worst.slope = std::max(worst.slope, off);
                worst.meanSlope += off;
                ++count;
            }
    EXPECT_GT(count, 100);
    worst.meanSlope /= std::max(count, 1);
    return worst;
}

const glm::dvec3 kHole(0.1, 0.0, -0.05);

TEST(Sculptor, FarDabsChangeNothing) {
    const auto base = gridOf(block, 32);
    for (const SculptToolInfo& info : sculptTools())
        for (const glm::dvec3& far :
             {glm::dvec3(0, 0, 9e8), glm::dvec3(-9e8, 0, 0), glm::dvec3(0, 1e300, 0)}) {
            Sculptor sculptor(base);
            Dab dab;
            dab.tool = info.tool;
            dab.centre = far;
            dab.radius = 0.1;
            dab.motion = glm::dvec3(0.05, 0, 0);
            dab.stamp = base;
            const DabReport report = sculptor.apply(dab);
            EXPECT_EQ(report.bricks, 0u) << info.name;
            EXPECT_EQ(report.removed, 0.0) << info.name;
            EXPECT_EQ(sculptor.grid()->hash(), base->hash()) << info.name;
        }
}

/// A dab that needs too many nodes is refused before what was undone is forgotten.
TEST(Sculptor, ATooLargeDabLeavesTheRedoList) {
    Sculptor sculptor(std::make_shared<FieldGrid>(gridOfDistance(cubeOf(520), 0.01, 0.01, block)));
    Dab dab;
    dab.centre = glm::dvec3(0.4, 0, 0);
    dab.radius = 0.02;
    ASSERT_GT(sculptor.apply(dab).bricks, 0u);
    ASSERT_TRUE(sculptor.undo());
    Dab large = dab;
    large.centre = glm::dvec3(0.0);
    large.radius = 1.0;
    EXPECT_THROW(sculptor.check(large), Error);
    EXPECT_THROW(sculptor.apply(large), Error);
    EXPECT_EQ(sculptor.redoSteps(), 1u);
    EXPECT_TRUE(sculptor.redo());
}

/// A ball inside of the block: two closed surfaces, everywhere smooth but at the block's edges.
TEST(Sculptor, CarvesABallOutOfABlock) {
    for (const int cells : {64, 128}) {
        Sculptor sculptor(gridOf(block, cells));
        const double radius = 0.12, voxel = cubeOf(cells).voxel;
        const DabReport report = sculptor.apply({.centre = kHole, .radius = radius});
        const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
        const auto truth = [&](const glm::dvec3& p) {
            return std::max(block(p), radius - glm::distance(p, kHole));
        };
        // The band on both sides of the hole; its middle and where the block is as near are kinks.
        const Worst worst = compare(*sculptor.grid(), truth, 4.0, [&](const glm::dvec3& p) {
            return glm::distance(p, kHole) > 3.0 * voxel && glm::distance(p, kHole) < radius + 0.08;
        });
        std::printf(
            "%d cells: volume %.6f of %.6f, surface within %.4f voxels, |grad| within %.4f, mean %.4f\n",
            cells, report.removed, volume, worst.distance, worst.slope, worst.meanSlope);
        EXPECT_NEAR(report.removed, volume, 0.01 * volume);
        EXPECT_LT(worst.distance, 0.1);
        EXPECT_LT(worst.slope, 0.05);
        EXPECT_GT(report.bricks, 0u);
    }
}

TEST(Sculptor, AddsABallAndMeasuresDistancesFromBothSides) {
    const glm::dvec3 centre(0.0, 0.4, 0.0);
    Sculptor sculptor(gridOf(block, 96));
    const double radius = 0.1;
    const DabReport report = sculptor.apply({.tool = SculptTool::Add, .centre = centre, .radius = radius});
    EXPECT_NEAR(report.removed, -2.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0), 3e-5);
    // Outside of a union the nearer of the two is the distance.
    const auto truth = [&](const glm::dvec3& p) {
        return std::min(block(p), glm::distance(p, centre) - radius);
    };
    const double voxel = cubeOf(96).voxel;
    const Worst worst = compare(*sculptor.grid(), truth, 4.0, [&](const glm::dvec3& p) {
        const double ball = glm::distance(p, centre) - radius;
        return p.y > 0.4 && std::abs(ball - (p.y - 0.4)) > 2.5 * voxel && std::abs(p.x) < 0.35 &&
               std::abs(p.z) < 0.35;
    });
    std::printf("surface within %.4f voxels, |grad| within %.4f\n", worst.distance, worst.slope);
    EXPECT_LT(worst.distance, 0.1);
    EXPECT_LT(worst.slope, 0.05);
    // Deep below the seam the block's face is gone: the depth is that of the dome.
    const FieldShape shape(sculptor.grid());
    EXPECT_NEAR(shape.value({0.0, 0.42, 0.0}), -0.08, 0.5 * voxel);
    EXPECT_NEAR(shape.value({0.0, 0.36, 0.0}), -std::hypot(0.1, 0.04), voxel);
}

/// Nodes at the faces of bricks are kept by each of them that was edited: one value, or the field has a
/// crack.
size_t cracksIn(const FieldGrid& grid) {
    size_t cracks = 0;
    std::array<float, kNodesInBrick> own, next;
    for (int z = 0; z < grid.bricks().z; ++z)
        for (int y = 0; y < grid.bricks().y; ++y)
            for (int x = 0; x < grid.bricks().x; ++x) {
                const glm::ivec3 brick(x, y, z);
                grid.copyBrick(brick, own);
                for (int axis = 0; axis < 3; ++axis) {
                    glm::ivec3 step(0), low(0);
                    step[axis] = 1;
                    low[axis] = kBrickCells;
                    if (!glm::all(glm::lessThan(brick + step, grid.bricks())))
                        continue;
                    grid.copyBrick(brick + step, next);
                    for (int b = 0; b <= kBrickCells; ++b)
                        for (int a = 0; a <= kBrickCells; ++a) {
                            glm::ivec3 at = low;
                            at[(axis + 1) % 3] = a;
                            at[(axis + 2) % 3] = b;
                            cracks += own[brickNode(at)] != next[brickNode(at - kBrickCells * step)] ? 1 : 0;
                        }
                }
            }
    return cracks;
}

/// What a dab's shape changes and its restoration puts back to what was there before.
TEST(Sculptor, LeavesNoCracksBetweenBricksWhereDistancesFollowShapes) {
    const auto base = gridOf(block, 80);
    const double voxel = cubeOf(80).voxel;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> within(-1.0, 1.0);
    for (const SculptTool tool : {SculptTool::Add, SculptTool::Carve})
        for (int run = 0; run < 12; ++run) {
            Sculptor sculptor(base);
            glm::dvec3 place(0.4 * within(random), 0.4 * within(random), 0.4 * within(random));
            place[run % 3] = 0.4;
            const glm::dvec3 way(within(random), within(random), within(random));
            for (int i = 0; i < 12; ++i) {
                sculptor.shape({.tool = tool,
                                .centre = place + 2.0 * voxel * glm::dvec3(within(random)),
                                .radius = 8.0 * voxel});
                place += 3.0 * voxel * way;
                if (i % 3 != 1)
                    sculptor.restore();
                ASSERT_EQ(cracksIn(*sculptor.grid()), 0u) << run << ", dab " << i;
            }
        }
}

TEST(NodeQueue, GivesNodesInTheOrderOfOneHeap) {
    std::mt19937_64 random(5);
    NodeQueue queue;
    for (int run = 0; run < 20; ++run) {
        using Entry = std::pair<float, uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> truth;
        queue.clear();
        const double reach = run % 4 == 3 ? 200.0 : 8.0; // voxels: beyond the last heap's, too
        for (int i = 0; i < 4000; ++i) {
            const bool pushes = truth.empty() || random() % 5 < 3;
            if (pushes) {
                // Some are equal, some nearer than what was popped.
                const auto distance = static_cast<float>(reach * static_cast<double>(random() % 512) / 512.0);
                const auto node = static_cast<uint32_t>(random() % 1000);
                queue.push({distance, node});
                truth.emplace(distance, node);
            } else {
                const NodeQueue::Entry entry = queue.pop();
                ASSERT_EQ(std::pair(entry.distance, entry.node), truth.top());
                truth.pop();
            }
            ASSERT_EQ(queue.empty(), truth.empty());
        }
    }
}

TEST(Sculptor, SmoothsBumpsAwayAndKeepsADistance) {
    const auto rough = [](const glm::dvec3& p) {
        return box(p, glm::dvec3(0.4)) + 0.006 * std::sin(2.0 * std::numbers::pi * p.x / 0.05);
    };
    Sculptor sculptor(gridOf(rough, 128));
    const auto height = [&] { // of the surface's waves, object units
        const FieldShape shape(sculptor.grid());
        double low = 1.0, high = -1.0;
        for (double x = -0.05; x <= 0.05; x += 0.0025) {
            const double f = shape.value({x, 0.4, 0.0});
            low = std::min(low, f);
            high = std::max(high, f);
        }
        return high - low;
    };
    const double before = height();
    for (int i = 0; i < 8; ++i)
        sculptor.apply({.tool = SculptTool::Smooth, .centre = {0.0, 0.4, 0.0}, .radius = 0.2});
    std::printf("waves %.5f before, %.5f after\n", before, height());
    EXPECT_LT(height(), 0.2 * before);
}

TEST(Sculptor, DragsTheSurfaceAsFarAsTheToolMoves) {
    Sculptor sculptor(gridOf(block, 128));
    const double voxel = cubeOf(128).voxel, radius = 0.15;
    sculptor.apply(
        {.tool = SculptTool::Drag, .centre = {0.0, 0.43, 0.0}, .motion = {0.0, 0.03, 0.0}, .radius = radius});
    const FieldShape shape(sculptor.grid());
    // The bell is 1 where the tool is and zero at the radius.
    EXPECT_NEAR(shape.value({0.0, 0.43, 0.0}), 0.0, 0.7 * voxel);
    EXPECT_NEAR(shape.value({0.2, 0.4, 0.0}), 0.0, 0.1 * voxel);
    const Worst worst = compare(
        *sculptor.grid(), [&](const glm::dvec3& p) { return shape.value(p); }, 3.0,
        [&](const glm::dvec3& p) { return glm::length(p - glm::dvec3(0, 0.4, 0)) < 0.2; });
    std::printf("|grad| within %.4f, mean %.4f\n", worst.slope, worst.meanSlope);
    EXPECT_LT(worst.slope, 0.05);
    EXPECT_LT(worst.meanSlope, 0.02);
}

TEST(Sculptor, StampsAndImprintsAnotherField) {
    const auto stamp = gridOf(torus, 64);
    Sculptor sculptor(gridOf(block, 128));
    const glm::dvec3 centre(0.0, 0.0, 0.4);
    const DabReport out =
        sculptor.apply({.tool = SculptTool::Imprint, .centre = centre, .radius = 0.21, .stamp = stamp});
    // Half of the torus 0.3, 0.12, at half its size: the longest side of its cells' box is 0.42 and a voxel.
    const double half = 0.21 / (0.5 * (stamp->high().x - stamp->low().x));
    const double volume =
        0.5 * 2.0 * std::numbers::pi * std::numbers::pi * 0.3 * 0.12 * 0.12 * std::pow(half, 3);
    std::printf("imprint %.6f of %.6f\n", out.removed, volume);
    EXPECT_NEAR(out.removed, volume, 0.02 * volume);
    const DabReport in =
        sculptor.apply({.tool = SculptTool::Stamp, .centre = centre, .radius = 0.21, .stamp = stamp});
    EXPECT_NEAR(in.removed, -2.0 * volume, 0.04 * volume);
}

TEST(Sculptor, KeepsWhatTheToolDoesNotReach) {
    const auto base = gridOf(block, 96);
    Sculptor sculptor(base);
    sculptor.apply({.centre = {0.4, 0.4, 0.4}, .radius = 0.05});
    const FieldLayout& layout = base->layout();
    int changed = 0;
    for (int z = 0; z <= layout.cells.z; ++z)
        for (int y = 0; y <= layout.cells.y; ++y)
            for (int x = 0; x <= layout.cells.x; ++x)
                if (sculptor.grid()->node({x, y, z}) != base->node({x, y, z})) {
                    ++changed;
                    const glm::dvec3 p = layout.origin + layout.voxel * glm::dvec3(x, y, z);
                    EXPECT_LT(glm::distance(p, glm::dvec3(0.4)), 0.05 + 0.2 + 0.1);
                }
    EXPECT_GT(changed, 0);
    // A tool in the air and one deep in the solid that adds change nothing.
    Sculptor idle(base);
    EXPECT_EQ(idle.apply({.centre = {0.55, 0.55, 0.55}, .radius = 0.02}).bricks, 0u);
    EXPECT_EQ(idle.apply({.tool = SculptTool::Add, .centre = glm::dvec3(0.0), .radius = 0.05}).bricks, 0u);
    EXPECT_EQ(idle.grid().get(), base.get());
    EXPECT_FALSE(idle.undo());
}

Dab randomDab(std::mt19937& random, const std::shared_ptr<const FieldGrid>& stamp) {
    std::uniform_real_distribution<double> place(-0.55, 0.55), unit(0.0, 1.0), step(-0.03, 0.03);
    Dab dab;
    dab.tool = sculptTools()[random() % sculptTools().size()].tool;
    dab.centre = {place(random), place(random), place(random)};
    dab.motion = {step(random), step(random), step(random)};
    dab.radius = 0.03 + 0.1 * unit(random);
    dab.strength = 0.05 + 0.95 * unit(random);
    dab.falloff = unit(random) < 0.3 ? 0.0 : unit(random);
    dab.stamp = stamp;
    return dab;
}

TEST(Sculptor, UndoOf200StrokesRestoresTheBytesAndRedoRepeatsThem) {
    const auto base = gridOf(block, 64), stamp = gridOf(torus, 32);
    const std::vector<float> original = allNodes(*base);
    Sculptor sculptor(base);
    std::mt19937 random(7);
    std::vector<uint64_t> hashes{base->hash()};
    for (int i = 0; i < 200; ++i) {
        sculptor.beginStroke();
        for (int k = 0; k < 3; ++k)
            sculptor.apply(randomDab(random, stamp));
        if (sculptor.grid()->hash() != hashes.back())
            hashes.push_back(sculptor.grid()->hash());
    }
    EXPECT_GT(hashes.size(), 150u);
    EXPECT_EQ(sculptor.undoSteps() + 1, hashes.size());
    const std::vector<float> sculpted = allNodes(*sculptor.grid());
    for (size_t i = hashes.size() - 1; i > 0; --i) {
        EXPECT_EQ(sculptor.grid()->hash(), hashes[i]);
        EXPECT_TRUE(sculptor.undo());
    }
    EXPECT_FALSE(sculptor.undo());
    EXPECT_EQ(sculptor.grid().get(), base.get());
    EXPECT_EQ(allNodes(*sculptor.grid()), original);
    while (sculptor.redo()) {
    }
    EXPECT_EQ(sculptor.grid()->hash(), hashes.back());
    EXPECT_EQ(allNodes(*sculptor.grid()), sculpted);
    EXPECT_GT(sculptor.memoryBytes(), 0u);
    // A new stroke forgets what was undone.
    sculptor.undo();
    sculptor.beginStroke();
    sculptor.apply({.centre = glm::dvec3(0.0), .radius = 0.2});
    EXPECT_EQ(sculptor.redoSteps(), 0u);
}

/// A place that is handed on without being on the surface makes distances too short, and the next dab hands
/// on shorter ones: over a stroke nodes far from the tool would come to lie voxels too near.
TEST(Sculptor, AStrokeLeavesDistancesToOtherPlacesAlone) {
    const auto base = gridOf(ball, 96);
    const double voxel = base->layout().voxel, radius = 4.5 * voxel;
    for (const SculptTool tool : {SculptTool::Add, SculptTool::Smooth, SculptTool::Drag, SculptTool::Carve}) {
        Sculptor sculptor(base);
        std::vector<glm::dvec3> centres;
        for (int i = 0; i < 40; ++i) {
            const double u = 0.25 * radius * i / 0.4, v = 0.3 * std::sin(10.0 * u);
            const double out = tool == SculptTool::Add ? 0.4 - radius + 0.75 * voxel : 0.4;
            centres.push_back(out * glm::normalize(glm::dvec3(std::sin(u), v, std::cos(u))));
            sculptor.apply({.tool = tool,
                            .centre = centres.back(),
                            .motion = i > 0 ? centres[centres.size() - 1] - centres[centres.size() - 2]
                                            : glm::dvec3(0.0),
                            .radius = radius});
        }
        const FieldGrid& grid = *sculptor.grid();
        double worst = 0.0;
        int count = 0;
        for (int z = 0; z <= 96; ++z)
            for (int y = 0; y <= 96; ++y)
                for (int x = 0; x <= 96; ++x) {
                    const glm::dvec3 p = base->layout().origin + voxel * glm::dvec3(x, y, z);
                    const double before = base->node({x, y, z});
                    const auto near = [&](const glm::dvec3& centre) {
                        // Its foot, or a surface that came to be nearer than that.
                        return glm::distance(0.4 / glm::length(p) * p, centre) < radius + 5.0 * voxel ||
                               glm::distance(p, centre) - radius < -before + voxel;
                    };
                    if (before > 0.0 || before < -0.9 * base->inside() || std::ranges::any_of(centres, near))
                        continue;
                    worst = std::max(worst, std::abs(grid.node({x, y, z}) - before) / voxel);
                    ++count;
                }
        EXPECT_GT(count, 1000);
        EXPECT_LT(worst, 0.01) << infoOf(tool).name;
        std::printf(
            "%s: %d nodes whose nearest place was not reached, %.4f voxels off, Lipschitz bound %.3f\n",
            infoOf(tool).name, count, worst, grid.lipschitz());
        if (tool == SculptTool::Smooth || tool == SculptTool::Drag) {
            EXPECT_LT(grid.lipschitz(), 1.15); // along a ball they change next to nothing
        }
    }
}

/// Every cell of every grid that a random journal makes is finite, bounded, inside of its border, and its
/// gradient keeps the bound; the same journal gives the same field.
TEST(Sculptor, RandomJournalsKeepTheFieldSoundAndRepeatToTheLastBit) {
    const auto stamp = gridOf(torus, 32);
    for (unsigned seed = 0; seed < 4; ++seed) {
        const auto base = gridOf(seed % 2 == 0 ? Distance(ball) : Distance(block), 48);
        Sculptor one(base), other(base);
        std::mt19937 a(seed), b(seed);
        for (int i = 0; i < 60; ++i) {
            one.apply(randomDab(a, stamp));
            other.apply(randomDab(b, stamp));
        }
        EXPECT_EQ(one.grid()->hash(), other.grid()->hash());
        const FieldGrid& grid = *one.grid();
        const glm::ivec3 n = grid.layout().cells;
        for (int z = 0; z <= n.z; ++z)
            for (int y = 0; y <= n.y; ++y)
                for (int x = 0; x <= n.x; ++x) {
                    const double f = grid.node({x, y, z});
                    ASSERT_TRUE(f >= -grid.inside() * (1.0 + 1e-6) && f <= grid.outside() * (1.0 + 1e-6))
                        << f;
                    const bool border = x == 0 || y == 0 || z == 0 || x == n.x || y == n.y || z == n.z;
                    ASSERT_TRUE(!border || f > 0.0);
                }
        EXPECT_LT(grid.lipschitz(), 2.5);
        std::printf("seed %u: Lipschitz bound %.3f\n", seed, grid.lipschitz());
    }
}

TEST(Sculptor, RefusesBadValuesAndChangesNothing) {
    const auto base = gridOf(ball, 32);
    Sculptor sculptor(base);
    const Dab good{.centre = {0.4, 0.0, 0.0}, .radius = 0.1};
    const auto refused = [&](const auto& spoil) {
        Dab dab = good;
        spoil(dab);
        EXPECT_THROW(sculptor.apply(dab), Error);
        EXPECT_EQ(sculptor.grid().get(), base.get());
    };
    refused([](Dab& d) { d.centre.y = NAN; });
    refused([](Dab& d) { d.centre.x = INFINITY; });
    refused([](Dab& d) { d.motion.z = NAN; });
    refused([](Dab& d) { d.motion.z = 1e9; });
    refused([](Dab& d) { d.radius = 0.0; });
    refused([](Dab& d) { d.radius = -1.0; });
    refused([](Dab& d) { d.radius = NAN; });
    refused([](Dab& d) { d.radius = 1e30; });
    refused([](Dab& d) { d.strength = 0.0; });
    refused([](Dab& d) { d.strength = 1.1; });
    refused([](Dab& d) { d.falloff = -0.1; });
    refused([](Dab& d) { d.falloff = NAN; });
    refused([](Dab& d) { d.tool = SculptTool::Stamp; });
    // Far away from the grid is no error: the tool may leave it.
    EXPECT_EQ(sculptor.apply({.centre = glm::dvec3(1e6), .radius = 0.1}).bricks, 0u);
    // The ball may take all of it.
    EXPECT_GT(sculptor.apply({.centre = glm::dvec3(0.0), .radius = 1.0}).bricks, 0u);
    const FieldShape nothing(sculptor.grid());
    EXPECT_GT(nothing.value(glm::dvec3(0.0)), 0.0);
}

} // namespace
} // namespace touchstone::test::sculptor_test
