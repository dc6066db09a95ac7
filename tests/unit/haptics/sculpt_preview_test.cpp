// Dabs that are felt while distances are restored, and made afterwards.

#include "haptics/shape/field/sculpt/sculptor.h"
#include "tests/support/field_nodes.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchstone::test::sculpt_preview_test {
namespace {

const Dab kFirst{.tool = SculptTool::Add, .centre = {0.39, 0.05, -0.1}, .radius = 0.11};
const std::array<Dab, 3> kLater{
    Dab{.tool = SculptTool::Add, .centre = {0.40, 0.22, -0.1}, .radius = 0.11}, // meets the first one
    Dab{.tool = SculptTool::Carve, .centre = {0.41, 0.12, -0.05}, .radius = 0.08},
    Dab{.tool = SculptTool::Carve, .centre = {-0.42, 0.0, 0.1}, .radius = 0.1}};

/// After a preview the surface is where the dab will leave it, and no distance is too long on either side.
TEST(SculptPreview, HasTheSurfaceAndBounds) {
    const auto base = gridOf(block, 96);
    const double voxel = base->layout().voxel;
    for (const Dab& later : kLater) {
        Sculptor whole(base), sculptor(base);
        whole.apply(kFirst);
        whole.apply(later);
        const std::vector<float> done = allNodes(*whole.grid());
        sculptor.shape(kFirst);
        const uint64_t before = sculptor.grid()->hash();
        EXPECT_GT(sculptor.preview(later).bricks, 0u);
        EXPECT_TRUE(sculptor.previews());
        EXPECT_NE(sculptor.grid()->hash(), before);
        const std::vector<float> felt = allNodes(*sculptor.grid());
        double longest = 0.0; // beyond the distances of two dabs, of which each is off by as much as this
        for (size_t i = 0; i < done.size(); ++i) {
            ASSERT_EQ(done[i] < 0.0f, felt[i] < 0.0f) << "the surface is where it will be";
            if (const double far = std::abs(done[i]); far < 0.9 * base->outside())
                longest = std::max(longest, (std::abs(static_cast<double>(felt[i])) - far) / voxel);
        }
        std::printf("preview: at most %.4f voxels longer than the restored distance\n", longest);
        EXPECT_LT(longest, 0.06);
    }
}

/// It is no part of a stroke, and the next change ends it.
TEST(SculptPreview, LeavesNothingBehind) {
    const auto base = gridOf(block, 96);
    Sculptor without(base), with(base);
    without.shape(kFirst);
    with.shape(kFirst);
    for (const Dab& later : kLater)
        with.preview(later);
    EXPECT_TRUE(with.owesDistances());
    without.restore();
    with.restore();
    EXPECT_FALSE(with.previews());
    EXPECT_EQ(with.grid()->hash(), without.grid()->hash());
    for (const Dab& later : kLater) {
        without.apply(later);
        with.preview(kFirst);
        with.preview(later);
        with.shape(later);
        EXPECT_FALSE(with.previews());
        with.restore();
        EXPECT_EQ(with.grid()->hash(), without.grid()->hash());
    }
    EXPECT_EQ(with.undoSteps(), 1u);
    with.preview(kLater[0]);
    EXPECT_TRUE(with.undo());
    EXPECT_EQ(with.grid().get(), base.get());
    with.preview(kLater[0]);
    EXPECT_TRUE(with.redo());
    EXPECT_EQ(with.grid()->hash(), without.grid()->hash());
    EXPECT_EQ(with.preview({.tool = SculptTool::Smooth, .centre = {0.4, 0.0, 0.0}, .radius = 0.1}).bricks, 0u)
        << "not of a whole ball";
    EXPECT_EQ(with.preview({.centre = {9.0, 0.0, 0.0}, .radius = 0.1}).bricks, 0u) << "beside the grid";
}

/// Between the steps of a restoration the field is the same as before it: a journal that has the previews
/// first repeats what was felt.
TEST(SculptPreview, MayBeMadeBetweenTheStepsOfARestoration) {
    const auto base = gridOf(block, 96);
    Sculptor first(base), between(base), without(base);
    for (Sculptor* const sculptor : {&first, &between, &without})
        sculptor->shape(kFirst);
    std::vector<uint64_t> felt;
    for (const Dab& later : kLater) {
        first.preview(later);
        felt.push_back(first.grid()->hash());
    }
    first.restore();
    without.restore();
    size_t calls = 0, made = 0;
    between.restore([&] {
        if (++calls % 7 != 3 || made == kLater.size())
            return;
        between.preview(kLater[made]);
        EXPECT_EQ(between.grid()->hash(), felt[made]);
        ++made;
    });
    EXPECT_GT(calls, 25u);
    EXPECT_EQ(made, kLater.size());
    EXPECT_EQ(first.grid()->hash(), without.grid()->hash());
    EXPECT_EQ(between.grid()->hash(), without.grid()->hash());
}

/// A restoration that fails between its steps leaves the field as it was, and may be made again.
TEST(SculptPreview, WhatThrowsWithinARestorationLeavesTheDistancesOwed) {
    const auto base = gridOf(block, 96);
    for (const size_t at : {1, 5, 20}) {
        Sculptor sculptor(base), without(base);
        sculptor.shape(kFirst);
        without.apply(kFirst);
        const uint64_t shaped = sculptor.grid()->hash();
        size_t calls = 0;
        EXPECT_THROW(sculptor.restore([&] {
            if (++calls == at)
                throw std::runtime_error("no memory");
        }),
                     std::runtime_error);
        EXPECT_EQ(calls, at);
        EXPECT_TRUE(sculptor.owesDistances());
        EXPECT_EQ(sculptor.grid()->hash(), shaped);
        sculptor.restore();
        EXPECT_FALSE(sculptor.owesDistances());
        EXPECT_EQ(sculptor.grid()->hash(), without.grid()->hash());
        EXPECT_TRUE(sculptor.undo());
        EXPECT_EQ(sculptor.grid().get(), base.get());
    }
}

/// A copy of a field that reads the bricks alone that are named as changed.
class Follower {
  public:
    void follow(Sculptor& sculptor) {
        const FieldGrid& grid = *sculptor.grid();
        for (const uint32_t number : sculptor.takeChangedBricks())
            bricks_[number] = nodesOf(grid, number);
    }
    [[nodiscard]] bool agrees(const FieldGrid& base, const FieldGrid& grid) const {
        const glm::ivec3 size = grid.bricks();
        for (uint32_t number = 0; number < static_cast<uint32_t>(size.x * size.y * size.z); ++number) {
            const auto found = bricks_.find(number);
            if ((found != bricks_.end() ? found->second : nodesOf(base, number)) != nodesOf(grid, number))
                return false;
        }
        return true;
    }

  private:
    [[nodiscard]] static std::vector<float> nodesOf(const FieldGrid& grid, uint32_t number) {
        const glm::ivec3 size = grid.bricks();
        const auto at = static_cast<int>(number);
        const glm::ivec3 brick(at % size.x, at / size.x % size.y, at / (size.x * size.y));
        EXPECT_EQ(grid.brickNumber(brick), number);
        std::vector<float> nodes(FieldGrid::kBrickNodes);
        grid.copyBrick(brick, std::span<float, FieldGrid::kBrickNodes>(nodes));
        return nodes;
    }
    std::map<uint32_t, std::vector<float>> bricks_;
};

/// Previews among all other changes change nothing but what is felt meanwhile; who draws changed bricks alone
/// sees every field.
TEST(SculptPreview, MayComeBetweenAllOtherChanges) {
    const auto base = gridOf(ball, 64);
    Sculptor with(base), without(base);
    Follower follower;
    std::mt19937 random(7), aside(8);
    const auto number = [](std::mt19937& from, double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(from);
    };
    const auto dabOf = [&](std::mt19937& from) {
        Dab dab;
        dab.tool = from() % 2 == 0 ? SculptTool::Carve : SculptTool::Add;
        dab.centre = {number(from, -0.5, 0.5), number(from, -0.5, 0.5), number(from, -0.5, 0.5)};
        dab.radius = number(from, 0.03, 0.13);
        return dab;
    };
    size_t previews = 0;
    const auto preview = [&] {
        previews += with.preview(dabOf(aside)).bricks > 0 ? 1 : 0;
        if (aside() % 3 == 0)
            follower.follow(with);
    };
    for (int i = 0; i < 150; ++i) {
        while (aside() % 2 == 0)
            preview();
        Dab dab = dabOf(random);
        const uint32_t change = random() % 8;
        for (Sculptor* const sculptor : {&with, &without})
            if (change == 0)
                (void)sculptor->undo();
            else if (change == 1)
                (void)sculptor->redo();
            else if (change == 2)
                sculptor->beginStroke();
            else if (change == 3)
                sculptor->restore(sculptor == &with ? preview : std::function<void()>());
            else if (change == 4)
                sculptor->apply(dab);
            else
                sculptor->shape(dab);
        ASSERT_EQ(with.grid()->hash(), without.grid()->hash()) << i;
        follower.follow(with);
        ASSERT_TRUE(follower.agrees(*base, *with.grid())) << i;
    }
    EXPECT_GT(previews, 100u);
    EXPECT_EQ(with.undoSteps(), without.undoSteps());
    while (with.undo()) {
    }
    EXPECT_EQ(allNodes(*with.grid()), allNodes(*base));
}

} // namespace
} // namespace touchstone::test::sculpt_preview_test
