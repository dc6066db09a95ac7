#include "haptics/query/surface_pick.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test {
namespace {

Scene sphereScene(SideChoice sides) {
    Scene scene = sceneOf(assets::sphere(0.05, 96, 64));
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
    const TouchBench both(sphereScene(SideChoice::Both)), front(sphereScene(SideChoice::Front));
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    const auto pick = pickSurface(*both.scene, {}, glm::dvec3(0.0), along);
    ASSERT_TRUE(pick);
    EXPECT_LT(glm::dot(pick->normal, along), -0.99);
    EXPECT_FALSE(pickSurface(*front.scene, {}, glm::dvec3(0.0), along));
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

} // namespace
} // namespace touchstone::test
