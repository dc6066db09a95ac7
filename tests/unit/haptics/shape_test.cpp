// A shape that is no mesh, beside a mesh and in contact with the hand at once: a ball that rests in a floor.

#include "haptics/scene/shape_object.h"
#include "haptics/settings/tick_flags.h"
#include "tests/support/corner.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace touchstone::test::shape_test {
namespace {

/// About the origin, radius 1/2.
class Ball final : public Shape {
  public:
    double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                 double limit) const noexcept override {
        const double reach = 0.5 + radius, a = glm::dot(motion, motion), b = glm::dot(centre, motion),
                     c = glm::dot(centre, centre) - reach * reach;
        if (!(b < -1e-13 * std::sqrt(a) * reach) || b * b < a * c)
            return limit;
        return std::clamp(c / (-b + std::sqrt(b * b - a * c)), 0.0, limit);
    }
    size_t near(const glm::dvec3& point, double reach,
                std::span<FeatureDistance> found) const noexcept override {
        found[0] = distanceFrom(0, point);
        return found[0].distance <= reach ? 1 : 0;
    }
    FeatureDistance distanceFrom(FeatureId, const glm::dvec3& point) const noexcept override {
        const double length = glm::length(point);
        const glm::dvec3 out = length > 0.0 ? point / length : glm::dvec3(0, 1, 0);
        return {.distance = length - 0.5, .gradient = out, .closest = 0.5 * out};
    }
    glm::dvec3 shadingNormal(FeatureId, const glm::dvec3&) const noexcept override { return glm::dvec3(0.0); }
    bool hasShadingNormals() const noexcept override { return false; }
    bool contains(const glm::dvec3& point) const noexcept override { return glm::length(point) < 0.5; }
    double boundingRadius() const noexcept override { return 0.5; }
    uint64_t memoryBytes() const noexcept override { return sizeof *this; }
    uint64_t identity() const noexcept override { return 0x62616c6c; }
};

constexpr double kRadius = kCornerRadius, kBall = 0.05, kReach = kBall + kRadius;
constexpr double kFloorStiffness = 300.0, kBallStiffness = 900.0;

/// The floor of a corner scene with the ball's centre at `centre` (workspace m).
struct FloorAndBall : TouchBench {
    glm::dvec3 centre;
    double floor; ///< m, height
    explicit FloorAndBall(const glm::dvec3& at)
        : TouchBench(cornerScene({{.normal = {0, 1, 0}, .stiffness = kFloorStiffness}}), cornerSettings()),
          centre(at), floor(cornerOf(*scene).offsets[0]) {
        const std::shared_ptr<HapticScene> both = copyOf(*scene);
        both->materials.push_back(both->materials[0]);
        both->materials[1].stiffness = kBallStiffness;
        addShape(*both, "ball", std::make_shared<Ball>(), 1, poseAt(at));
        scene = both;
    }
    static Similarity poseAt(const glm::dvec3& at) { return {2.0 * kBall, {0.5, 0.5, -0.5, 0.5}, at}; }

    /// Where the proxy is nearest to `hip`, the elastic force there, and the number of planes that hold it.
    std::tuple<glm::dvec3, glm::dvec3, int> closedForm(const glm::dvec3& hip) const {
        const glm::dvec3 up(0, 1, 0), onFloor(hip.x, floor + kRadius, hip.z);
        const glm::dvec3 onBall = centre + kReach * glm::normalize(hip - centre);
        const bool inFloor = hip.y < floor + kRadius, inBall = glm::distance(hip, centre) < kReach;
        if (!inFloor && !inBall)
            return {hip, glm::dvec3(0.0), 0};
        if (inFloor && glm::distance(onFloor, centre) >= kReach)
            return {onFloor, kFloorStiffness * (onFloor - hip), 1};
        if (inBall && onBall.y >= floor + kRadius)
            return {onBall, kBallStiffness * (onBall - hip), 1};
        const double below = centre.y - floor - kRadius;
        const glm::dvec3 out = glm::normalize(glm::dvec3(hip.x - centre.x, 0, hip.z - centre.z));
        const glm::dvec3 place = centre - below * up + std::sqrt(kReach * kReach - below * below) * out;
        const glm::dvec3 away = glm::normalize(place - centre);
        const std::vector<double> load = coefficients({up, away}, place - hip);
        return {place, kFloorStiffness * load[0] * up + kBallStiffness * load[1] * away, 2};
    }
};

TEST(Shape, AMeshAndAShapeAreTouchedAtOnceAsTheClosedFormSays) {
    FloorAndBall bench({0.01, 0.03, -0.02});
    const double groove = std::sqrt(kBall * kBall - 0.03 * 0.03);
    std::array<int, 3> held{};
    double off = 0.0, wrong = 0.0;
    const auto at = [&](int i) {
        const double turn = 2e-4 * 3.14159265 * i;
        return bench.centre +
               (groove + 0.004 * std::sin(7.0 * turn)) * glm::dvec3(std::cos(turn), 0, std::sin(turn)) +
               glm::dvec3(0, 0.0005 + 0.003 * std::sin(11.0 * turn) - 0.03, 0);
    };
    bench.step({0.2, 0.1, 0.0});
    bench.moveTo(at(0) + glm::dvec3(0, 0.01, 0), 0.2);
    bench.moveTo(at(0), 0.1);
    for (int i = 0; i <= 10000; ++i) {
        const HapticOutput& out = bench.step(at(i));
        const auto [place, force, planes] = bench.closedForm(out.hip);
        ++held[static_cast<size_t>(planes)];
        EXPECT_NEAR(glm::length(out.normal), planes > 0 ? 1.0 : 0.0, 1e-9) << i;
        off = std::max(off, glm::distance(out.proxy, place));
        wrong = std::max(wrong, glm::distance(out.force, force));
    }
    EXPECT_LT(off, 1e-9);
    EXPECT_LT(wrong, 1e-6);
    for (const int ticks : held)
        EXPECT_GT(ticks, 500);
    printf("floor and ball: %.2g m and %.2g N off the closed form; %d ticks in contact with both\n", off,
           wrong, held[2]);
}

/// One or two objects of one shape move into a still hand. Two close in on it from both sides: each is a
/// contact of its own, and the proxy goes out between them, on the circle in which the balls of reach meet.
TEST(Shape, WhatMovesIntoAStillHandPushesItOutAsTheClosedFormSays) {
    const glm::dvec3 middle(0.0, 0.5, 0.0), hip(5e-4, 0.52, 1e-3), off = hip - middle;
    const double aside = glm::length(glm::dvec2(off.y, off.z));
    for (const size_t balls : {1u, 2u}) {
        FloorAndBall bench({-0.06, 0.5, 0.0});
        const std::shared_ptr<HapticScene> scene = copyOf(*bench.scene);
        if (balls == 2)
            addShape(*scene, "second", scene->objects[1]->shape, 1, FloorAndBall::poseAt({0.06, 0.5, 0.0}));
        bench.scene = scene;
        bench.motions.assign(scene->restMotions.begin(), scene->restMotions.end());
        bench.step(hip);
        ASSERT_EQ(bench.output.contacts, 0u);
        for (int i = 1; i <= 300; ++i) {
            const double half = 0.06 - 1e-4 * i; // of the distance of two centres
            bench.centre = middle - glm::dvec3(half, 0.0, 0.0);
            for (size_t ball = 1; ball <= balls; ++ball)
                bench.motions[ball] = {
                    FloorAndBall::poseAt(ball == 1 ? bench.centre : 2.0 * middle - bench.centre),
                    bench.motions[ball].workspaceFromObject, false};
            const HapticOutput& out = bench.step(hip);
            const double ring = std::sqrt(std::max(kReach * kReach - half * half, 0.0));
            EXPECT_FALSE(has(out.flags, TickFlag::Jammed)) << i;
            if (balls == 1 || ring > aside + 1e-3) {
                const glm::dvec3 place = balls == 1 ? std::get<0>(bench.closedForm(hip))
                                                    : middle + ring / aside * glm::dvec3(0.0, off.y, off.z);
                EXPECT_LT(glm::distance(out.proxy, place), 1e-8) << i;
                EXPECT_TRUE(balls == 1 || out.planeCount == 2u) << i;
            }
        }
        EXPECT_GT(bench.output.force.y, balls == 1 ? 1.0 : 5.0);
    }
}

} // namespace
} // namespace touchstone::test::shape_test
