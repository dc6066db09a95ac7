#include "assets/shapes.h"
#include "devices/simulated/simulated_hand.h"
#include "engine/core/error.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

namespace touchstone::simulated_hand_test {
namespace {

constexpr double kTick = 0.001;

std::vector<glm::dvec3> corners(const assets::Shape& shape) {
    std::vector<glm::dvec3> result;
    for (const uint32_t index : shape.indices)
        result.emplace_back(shape.positions[index]);
    return result;
}

/// How the hand fares over one period: the share of time below the surface and the depth it reaches. `height`
/// is the distance above the surface, negative inside.
struct Account {
    double deepest = 0.0, below = 0.0, highest = 0.0, fastest = 0.0;
};

Account account(const StrokePath& path, const std::function<double(const glm::dvec3&)>& height) {
    SimulatedHand hand(std::make_shared<const StrokePath>(path));
    Account result;
    glm::dvec3 previous = hand.sample(0.0).position;
    const int ticks = static_cast<int>(path.period() / kTick);
    for (int tick = 1; tick <= ticks; ++tick) {
        const DeviceSample sample = hand.sample(tick * kTick);
        EXPECT_TRUE(sample.valid);
        const double h = height(sample.position);
        result.deepest = std::max(result.deepest, -h);
        result.highest = std::max(result.highest, h);
        result.below += h < 0.0 ? 1.0 / ticks : 0.0;
        result.fastest = std::max(result.fastest, glm::distance(sample.position, previous) / kTick);
        previous = sample.position;
    }
    return result;
}

void addQuad(std::vector<glm::dvec3>& corners, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
             const glm::dvec3& d) {
    corners.insert(corners.end(), {a, b, c, a, c, d});
}

/// A level sheet from x0 to x1 at height z, 0.1 m long in y.
void addSheet(std::vector<glm::dvec3>& corners, double x0, double x1, double z) {
    addQuad(corners, {x0, -0.05, z}, {x1, -0.05, z}, {x1, 0.05, z}, {x0, 0.05, z});
}

TEST(SimulatedHand, PressesAMillimetreIntoASphere) {
    const StrokePath path = strokeOver(corners(assets::sphere(0.05, 60, 60)));
    const Account sphere = account(path, [](const glm::dvec3& p) { return glm::length(p) - 0.05; });
    EXPECT_NEAR(sphere.deepest, 0.001, 0.0001);
    EXPECT_GT(sphere.below, 0.7) << "most of the time is spent in touch";
    EXPECT_GT(sphere.highest, 0.009) << "and the hand lifts off";
    EXPECT_LE(sphere.fastest, 0.1 * (1 + 1e-9));
    EXPECT_GT(path.position(0.0).z, 0.05) << "it begins outside, on the viewer's side";
}

TEST(SimulatedHand, PressesAsDeepAsItIsTold) {
    StrokeOptions options;
    options.depth = 0.003;
    options.speed = 0.05;
    const Account sphere = account(strokeOver(corners(assets::sphere(0.05, 60, 60)), options),
                                   [](const glm::dvec3& p) { return glm::length(p) - 0.05; });
    EXPECT_NEAR(sphere.deepest, 0.003, 0.0002);
    EXPECT_LE(sphere.fastest, 0.05 * (1 + 1e-9));
}

TEST(SimulatedHand, FollowsTheRingOfADoughnut) {
    const Account doughnut =
        account(strokeOver(corners(assets::torus(0.06, 0.025, 90, 90))),
                [](const glm::dvec3& p) { return std::hypot(std::hypot(p.x, p.y) - 0.06, p.z) - 0.025; });
    EXPECT_NEAR(doughnut.deepest, 0.001, 0.0001);
    EXPECT_GT(doughnut.below, 0.8);
}

TEST(SimulatedHand, TakesAnotherSideOfASheetSeenEdgeOn) {
    const StrokePath path = strokeOver(corners(assets::plane(0.15, 0.15, 4, 4))); // lies in y = 0
    const Account sheet = account(path, [](const glm::dvec3& p) { return p.y; });
    EXPECT_NEAR(sheet.deepest, 0.001, 0.0001);
    EXPECT_GT(sheet.below, 0.7);
}

TEST(SimulatedHand, DoesNotGoThroughTheDiagonalsOfACube) {
    // A probe lost the diagonals of the faces, and the hand went for what lay behind: 150 mm deep.
    const auto height = [](const glm::dvec3& p) {
        const glm::dvec3 q = glm::abs(p) - 0.075;
        return std::max({q.x, q.y, q.z});
    };
    for (const auto& shape :
         {assets::boxWithSharedCorners(glm::dvec3(0.15)), assets::box(glm::dvec3(0.15))}) {
        const Account cube = account(strokeOver(corners(shape)), height);
        EXPECT_NEAR(cube.deepest, 0.001, 0.0001);
        EXPECT_GT(cube.below, 0.7);
    }
}

TEST(SimulatedHand, KeepsToItsDepthInAGrooveAndUnderAThinRoof) {
    // A groove of 30 degrees: a millimetre under both of its walls is 4 mm from a proxy at its bottom.
    std::vector<glm::dvec3> groove;
    const double wide = 0.02 * std::tan(std::numbers::pi / 12.0);
    addSheet(groove, -0.05, -wide, 0.02);
    addSheet(groove, wide, 0.05, 0.02);
    addQuad(groove, {-wide, -0.05, 0.02}, {0, -0.05, 0}, {0, 0.05, 0}, {-wide, 0.05, 0.02});
    addQuad(groove, {0, -0.05, 0}, {wide, -0.05, 0.02}, {wide, 0.05, 0.02}, {0, 0.05, 0});
    const StrokePath path = strokeOver(groove);
    double bottom = 1.0;
    bool touches = false;
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        touches = touches || (std::abs(p.x) > wide && p.z < 0.0192);
        if (std::abs(p.x) < wide)
            bottom = std::min(bottom, p.z);
    }
    EXPECT_TRUE(touches);
    // Where its walls are 2 d apart the proxy is held by both: no deeper than that.
    EXPECT_GT(bottom, -0.0015);
}

TEST(SimulatedHand, HopsOverGaps) {
    // Two boxes 100 mm apart.
    std::vector<glm::dvec3> two = corners(assets::box(glm::dvec3(0.05)));
    const size_t half = two.size();
    for (size_t i = 0; i < half; ++i)
        two.push_back(two[i] + glm::dvec3(0.075, 0, 0));
    for (size_t i = 0; i < half; ++i)
        two[i] -= glm::dvec3(0.075, 0, 0);
    const auto height = [](const glm::dvec3& p) {
        const glm::dvec3 q = glm::abs(glm::dvec3(std::abs(p.x) - 0.075, p.y, p.z)) - 0.025;
        return std::max({q.x, q.y, q.z});
    };
    const StrokePath path = strokeOver(two);
    const Account boxes = account(path, height);
    EXPECT_LE(boxes.deepest, 0.0011);
    EXPECT_GT(boxes.below, 0.3);
    bool left = false, right = false, leftHigh = false;
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        if (height(p) < -0.0005)
            (p.x < 0.0 ? left : right) = true;
        if (std::abs(p.x) < 0.04 && p.z > 0.03)
            leftHigh = true;
    }
    EXPECT_TRUE(left && right) << "both are touched";
    EXPECT_TRUE(leftHigh) << "in between the hand is in the air";
}

TEST(SimulatedHand, KeepsOffTheFootOfAStepHoweverLow) {
    // A hand that went on into the wall would leave its proxy at the foot: the force would grow with the way.
    for (const double step : {0.0001, 0.0005, 0.002, 0.01}) {
        SCOPED_TRACE(step);
        std::vector<glm::dvec3> corners;
        addSheet(corners, -0.05, 0.0, 0.0);
        addSheet(corners, 0.0, 0.05, step);
        addQuad(corners, {0, -0.05, 0}, {0, 0.05, 0}, {0, 0.05, step}, {0, -0.05, step});
        const StrokePath path = strokeOver(corners);
        bool low = false, high = false;
        for (double t = 0.0; t < path.period(); t += kTick) {
            const glm::dvec3 p = path.position(t);
            const bool atTheFoot = p.x < -0.0001 && p.x > -0.0015;
            EXPECT_TRUE(!atTheFoot || p.z > 0.0) << "x " << p.x << ", z " << p.z;
            low = low || (p.x < 0.0 && p.z < -0.0009);
            high = high || (p.x > 0.0 && p.z < step - 0.0009);
        }
        EXPECT_TRUE(low && high) << "both levels are stroked";
    }
}

TEST(SimulatedHand, DoesNotSlipUnderASheetThroughASlit) {
    std::vector<glm::dvec3> corners;
    addSheet(corners, -0.05, -0.0015, 0.0);
    addSheet(corners, 0.0015, 0.05, 0.0);
    const StrokePath path = strokeOver(corners);
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        EXPECT_TRUE(std::abs(p.x) > 0.0014 || p.z > 0.0) << "x " << p.x << ", z " << p.z;
    }
}

TEST(SimulatedHand, HopsOverAFenceHigherThanBothItsSides) {
    std::vector<glm::dvec3> corners;
    addSheet(corners, -0.05, 0.05, 0.0);
    addQuad(corners, {0, -0.05, 0}, {0, 0.05, 0}, {0.002, 0.05, 0.02}, {0.002, -0.05, 0.02});
    addQuad(corners, {0.002, -0.05, 0.02}, {0.002, 0.05, 0.02}, {0.004, 0.05, 0}, {0.004, -0.05, 0});
    const StrokePath path = strokeOver(corners);
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        // Under the nearer flank, whose normal is (10, 0, 1) / sqrt(101).
        const double under = (std::min(p.x, 0.004 - p.x) * 10.0 - p.z) / std::sqrt(101.0);
        EXPECT_LT(under, 0.0011) << "x " << p.x << ", z " << p.z;
    }
}

TEST(SimulatedHand, FindsATriangleThatIsAllThereIs) {
    // A long thin sliver that no ellipse meets, and a speck far away that stretches the bounds.
    const std::vector<glm::dvec3> sliver{{0, 0, 0},       {0.002, 0, 0},     {0, 0.002, 0.001},
                                         {0.1, 0.1, 0.1}, {0.101, 0.1, 0.1}, {0.1, 0.101, 0.1}};
    const StrokePath path = strokeOver(sliver);
    const glm::dvec3 middle = (sliver[3] + sliver[4] + sliver[5]) / 3.0;
    bool above = false, below = false;
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        if (std::hypot(p.x - middle.x, p.y - middle.y) > 0.0002)
            continue;
        above = above || p.z > middle.z + 0.005;
        below = below || (above && p.z < middle.z - 0.0005);
    }
    EXPECT_TRUE(below) << "the path goes down through it";
}

TEST(SimulatedHand, DoesNotPierceASmallModel) {
    const Account bead = account(strokeOver(corners(assets::sphere(0.002, 30, 30))),
                                 [](const glm::dvec3& p) { return glm::length(p) - 0.002; });
    EXPECT_GT(bead.deepest, 0.0002);
    EXPECT_LT(bead.deepest, 0.0008);
}

TEST(SimulatedHand, SaysWhenThereIsNothingToTouch) {
    const std::vector<glm::dvec3> none, point(3, glm::dvec3(0.01));
    EXPECT_THROW((void)strokeOver(none), Error);
    EXPECT_THROW((void)strokeOver(point), Error);
}

TEST(SimulatedHand, StrokesASceneAsItIsPlaced) {
    const assets::Shape shape = assets::sphere(0.5, 60, 60);
    Mesh mesh;
    mesh.positions = shape.positions;
    mesh.indices = shape.indices;
    Scene scene;
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, 0, glm::dmat4(1.0)});
    Similarity deviceFromScene;
    deviceFromScene.scale = 0.1;
    deviceFromScene.translation = {0.01, 0.0, 0.0};
    const Account sphere = account(strokeOver(scene, deviceFromScene), [](const glm::dvec3& p) {
        return glm::distance(p, glm::dvec3(0.01, 0.0, 0.0)) - 0.05;
    });
    EXPECT_NEAR(sphere.deepest, 0.001, 0.0001);
}

TEST(SimulatedHand, IsTheSameEveryTimeAndAllocatesNothing) {
    const auto shape = corners(assets::torus(0.06, 0.025, 40, 40));
    SimulatedHand one(std::make_shared<const StrokePath>(strokeOver(shape)));
    SimulatedHand other(std::make_shared<const StrokePath>(strokeOver(shape)));
    const uint64_t before = test::allocationsOnThisThread();
    bool same = true;
    for (int tick = 0; tick < 5000; ++tick)
        same = same && one.sample(tick * kTick).position == other.sample(tick * kTick).position;
    EXPECT_EQ(test::allocationsOnThisThread(), before);
    EXPECT_TRUE(same);
}

} // namespace
} // namespace touchstone::simulated_hand_test
