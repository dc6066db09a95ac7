// What a tool feels of what it takes away, and the dabs that a hand lays.

#include "haptics/force/tool_resistance.h"
#include "haptics/servo/tool_path.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace touchstone::test::tool_path_test {
namespace {

constexpr double kScale = 0.15, kVoxel = 1.2 / 96 * kScale;

/// Deep in a solid the ball sweeps its cross-section, half out of a face half of it, and none where it
/// leaves.
TEST(ToolResistance, IsTheSweptVolumeOfTheBall) {
    const auto half = fieldOf([](const glm::dvec3& p) { return box(p, glm::dvec3(0.4)); }, 96);
    const Similarity place{kScale, {1, 0, 0, 0}, {0.01, 0.02, 0.03}};
    constexpr double kRadius = 0.005, kSpeed = 0.1;
    const double whole = std::numbers::pi * kRadius * kRadius * kSpeed;
    for (const glm::dvec3& way : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0.6, 0.0, 0.8)})
        EXPECT_NEAR(sweptVolume(*half, place, place.translation, kRadius, kSpeed * way), whole, 0.03 * whole);
    const glm::dvec3 face = place.translation + glm::dvec3(0.0, 0.4 * kScale, 0.0);
    EXPECT_NEAR(sweptVolume(*half, place, face, kRadius, {kSpeed, 0.0, 0.0}), 0.5 * whole, 0.05 * whole);
    EXPECT_NEAR(sweptVolume(*half, place, face, kRadius, {0.0, -kSpeed, 0.0}), whole, 0.05 * whole);
    EXPECT_EQ(sweptVolume(*half, place, face, kRadius, {0.0, kSpeed, 0.0}), 0.0);
    EXPECT_EQ(sweptVolume(*half, place, place.translation, kRadius, glm::dvec3(0.0)), 0.0);
}

TEST(ToolResistance, OpposesTheMotionInProportionAndWithinWhatASampledLoopBears) {
    const auto solid = fieldOf([](const glm::dvec3& p) { return box(p, glm::dvec3(0.4)); }, 48);
    const Similarity place{kScale, {1, 0, 0, 0}, glm::dvec3(0.0)};
    LiveTool tool{.active = true, .radius = 0.005, .resistance = 1e5};
    const auto force = [&](const glm::dvec3& v) {
        return toolResistance(*solid, place, tool, glm::dvec3(0.0), v, 0.075, 1e-3);
    };
    const glm::dvec3 slow = force({0.05, 0.0, 0.0}), fast = force({0.1, 0.0, 0.0});
    EXPECT_NEAR(slow.x, -1e5 * std::numbers::pi * 2.5e-5 * 0.05, 0.03 * -slow.x);
    EXPECT_NEAR(fast.x, 2.0 * slow.x, 1e-12);
    EXPECT_EQ(glm::dvec2(slow.y, slow.z), glm::dvec2(0.0));
    tool.resistance = 1e9;
    EXPECT_NEAR(force({0.1, 0.0, 0.0}).x, -0.25 * 0.075 / 1e-3 * 0.1, 1e-12);
    for (const SculptTool other :
         {SculptTool::Add, SculptTool::Smooth, SculptTool::Stamp, SculptTool::Drag}) {
        tool.tool = other;
        EXPECT_EQ(force({0.1, 0.0, 0.0}), glm::dvec3(0.0)) << infoOf(other).name;
    }
}

struct Hand {
    FieldBench bench{fieldOf(ball, 96), kScale};
    ToolPath path;
    LiveTool tool{.active = true, .object = 1, .radius = 0.008};
    HapticOutput output;
    uint64_t tick = 0;

    std::vector<SculptEntry> at(const glm::dvec3& place, bool pressed, bool touches = false) {
        output.hip = output.proxy = FieldBench::kMiddle + place;
        output.contacts = touches ? 1 : 0;
        output.object = touches ? 1 : -1;
        std::array<SculptEntry, ToolPath::kMost> made;
        const size_t count = path.advance(tool, pressed, *bench.scene, bench.scene->restMotions,
                                          {.tick = ++tick, .dt = 1e-3, .hands = {}}, output, made);
        return {made.begin(), made.begin() + static_cast<ptrdiff_t>(count)};
    }
};

TEST(ToolPath, LaysDabsAQuarterOfTheRadiusApartWhileTheButtonIsHeld) {
    Hand hand;
    EXPECT_TRUE(hand.at({0.0, 0.06, 0.0}, false).empty());
    const std::vector<SculptEntry> first = hand.at({0.0, 0.06, 0.0}, true);
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(first[0].kind, SculptEntryKind::Begin);
    EXPECT_EQ(first[1].kind, SculptEntryKind::Dab);
    EXPECT_EQ(first[1].object, 1);
    EXPECT_EQ(first[1].tick, 2u);
    EXPECT_NEAR(first[1].centre.y, 0.06 / kScale, 1e-12);
    EXPECT_NEAR(first[1].radius, 0.008 / kScale, 1e-12);
    size_t dabs = 0;
    glm::dvec3 before = first[1].centre;
    for (int i = 1; i <= 100; ++i)
        for (const SculptEntry& dab : hand.at({0.0002 * i, 0.06, 0.0}, true)) {
            EXPECT_NEAR(glm::distance(dab.centre, before) * kScale, 0.002, 0.00021);
            before = dab.centre;
            ++dabs;
        }
    EXPECT_NEAR(static_cast<double>(dabs), 10.0, 1.0) << "20 mm at 2 mm";
    EXPECT_TRUE(hand.at({0.02, 0.06, 0.0}, false).empty());
    EXPECT_EQ(hand.at({0.05, 0.06, 0.0}, true).front().kind, SculptEntryKind::Begin);
    EXPECT_EQ(hand.at({0.15, 0.06, 0.0}, true).size(), ToolPath::kMost) << "a leap";
    hand.tool.active = false;
    EXPECT_TRUE(hand.at({0.2, 0.06, 0.0}, true).empty());
}

TEST(ToolPath, AddsOnTheSurfaceByLessThanAVoxelAndOnlyInContact) {
    Hand hand;
    hand.tool.tool = SculptTool::Add;
    EXPECT_TRUE(hand.at({0.0, 0.4 * kScale, 0.0}, true).empty()) << "no contact";
    std::vector<SculptEntry> made = hand.at({0.0, 0.4 * kScale, 0.0}, true, true);
    ASSERT_EQ(made.size(), 2u);
    const double top = (made[1].centre.y + made[1].radius) * kScale;
    EXPECT_NEAR(top, 0.4 * kScale + 0.75 * kVoxel, 0.02 * kVoxel);
    size_t repeated = 0;
    for (int i = 0; i < 320; ++i)
        repeated += hand.at({0.0, 0.4 * kScale, 0.0}, true, true).size();
    EXPECT_EQ(repeated, 10u) << "every 32 ms where the hand rests";
}

TEST(ToolPath, DragsByTheTipsMotionAndStampsOnce) {
    Hand hand;
    hand.tool.tool = SculptTool::Drag;
    EXPECT_EQ(hand.at({0.0, 0.06, 0.0}, true).size(), 1u) << "nothing has moved yet";
    glm::dvec3 motion(0.0);
    for (int i = 1; i <= 50; ++i)
        for (const SculptEntry& dab : hand.at({0.0, 0.06 + 0.0002 * i, 0.0}, true))
            motion += dab.motion;
    EXPECT_NEAR(motion.y * kScale, 0.01, 0.0021);
    (void)hand.at(glm::dvec3(0.0), false);
    hand.tool.tool = SculptTool::Stamp;
    EXPECT_TRUE(hand.at({0.0, 0.06, 0.0}, true).empty()) << "no stamp is chosen";
    hand.tool.stamp = 1;
    EXPECT_EQ(hand.at({0.0, 0.06, 0.0}, true).size(), 2u);
    for (int i = 1; i <= 50; ++i)
        EXPECT_TRUE(hand.at({0.0, 0.06 + 0.001 * i, 0.0}, true).empty());
}

} // namespace
} // namespace touchstone::test::tool_path_test
