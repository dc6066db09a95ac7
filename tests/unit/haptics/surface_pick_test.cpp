#include "haptics/query/surface_distance.h"
#include "haptics/query/surface_pick.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test::surface_pick_test {
namespace {

Scene sphereScene(SideChoice sides, double radius = 0.05) {
    Scene scene = sceneOf(assets::sphere(radius, 96, 64));
    scene.materials[0].haptic.sides = sides;
    return scene;
}

TEST(SurfacePick, FindsTheNearSideOfASphereFromAnywhere) {
    const TouchBench bench(sphereScene(SideChoice::Both));
    std::mt19937 random(3);
    std::normal_distribution<double> any;
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 out = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
        const auto pick = pickSurface(*bench.scene, {}, 0.3 * out, -out);
        ASSERT_TRUE(pick);
        // The facets sag by R (1 - cos(pi / 64)) at most.
        EXPECT_NEAR(glm::length(pick->point), 0.05, 0.05 * 2.5e-3);
        EXPECT_NEAR(glm::dot(glm::normalize(pick->point), out), 1.0, 1e-9);
        EXPECT_GT(glm::dot(pick->normal, out), 0.99);
        EXPECT_EQ(pick->object, 0);
        EXPECT_EQ(pick->material, 0);
        EXPECT_FALSE(pickSurface(*bench.scene, {}, 0.3 * out, out));
    }
}

TEST(SurfacePick, FromInsideSeesTheBackUnlessOnlyTheFrontIsThere) {
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    for (const double radius : {0.05, 5.0}) {
        const TouchBench both(sphereScene(SideChoice::Both, radius)),
            front(sphereScene(SideChoice::Front, radius));
        const auto pick = pickSurface(*both.scene, {}, glm::dvec3(0.0), along);
        ASSERT_TRUE(pick);
        EXPECT_LT(glm::dot(pick->normal, along), -0.99);
        EXPECT_FALSE(pickSurface(*front.scene, {}, glm::dvec3(0.0), along));
        EXPECT_TRUE(pickSurface(*front.scene, {}, -3.0 * radius * along, along)) << "its front";
    }
}

TEST(SurfacePick, FollowsAnObjectThatMoved) {
    TouchBench bench(sphereScene(SideChoice::Both));
    bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
    bench.motions[0].workspaceFromObject.translation += glm::dvec3(0.0, 0.2, 0.0);
    const glm::dvec3 from(0.0, 0.2, 0.4), along(0.0, 0.0, -1.0);
    EXPECT_FALSE(pickSurface(*bench.scene, {}, from, along));
    const auto pick = pickSurface(*bench.scene, bench.motions, from, along);
    ASSERT_TRUE(pick);
    EXPECT_NEAR(pick->point.z, 0.05, 0.05 * 2.5e-3);
    EXPECT_NEAR(pick->point.y, 0.2, 1e-9);
}

TEST(SurfaceDistance, IsThatOfTheNearestTriangleWhereverTheObjectIs) {
    TouchBench bench(sphereScene(SideChoice::Both));
    bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
    const glm::dvec3 moved(0.1, -0.2, 0.3);
    bench.motions[0].workspaceFromObject.translation += moved;
    std::mt19937 random(5);
    std::normal_distribution<double> any;
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 out = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
        for (const double radius : {0.02, 0.049, 0.051, 0.08}) {
            const double expected = std::abs(radius - 0.05), sag = 0.05 * 2.5e-3;
            EXPECT_NEAR(surfaceDistance(*bench.scene, {}, radius * out, 1.0), expected, sag);
            EXPECT_NEAR(surfaceDistance(*bench.scene, bench.motions, moved + radius * out, 1.0), expected,
                        sag);
            EXPECT_EQ(surfaceDistance(*bench.scene, {}, radius * out, 0.5 * (expected - sag)),
                      0.5 * (expected - sag))
                << "none so near";
        }
    }
}

} // namespace
} // namespace touchstone::test::surface_pick_test
