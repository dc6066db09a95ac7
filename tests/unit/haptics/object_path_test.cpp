// Where objects are within a tick, and which of them a hand is near.

#include "assets/shapes.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/solve/object_path.h"
#include "tests/support/touch_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::test::object_path_test {
namespace {

/// A turn by `angle` about the axis through `pivot` along `axis`, and `rise` along it.
Similarity screwed(const Similarity& pose, double angle, const glm::dvec3& pivot, const glm::dvec3& axis,
                   double rise) {
    const glm::dquat turn = glm::angleAxis(angle, axis);
    return {pose.scale, turn * pose.rotation, pivot + turn * (pose.translation - pivot) + rise * axis};
}

double apart(const Similarity& a, const Similarity& b) {
    double most = std::abs(a.scale - b.scale);
    for (const glm::dvec3& point : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
        most = std::max(most, glm::distance(a.point(point), b.point(point)));
    return most;
}

TEST(ObjectPath, ATurnAndASlideAreOneScrewWhereverTheOriginLies) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, -0.5)), pivot(0.3, -0.2, 0.1);
    const Similarity before{0.2, glm::angleAxis(0.4, glm::dvec3(0.0, 1.0, 0.0)), {0.5, 0.1, -0.3}};
    for (const double angle : {0.01, 0.5, 2.0, 3.1}) {
        const ObjectPath path({screwed(before, angle, pivot, axis, 0.07), before, false});
        EXPECT_NEAR(path.angle(), angle, 1e-9);
        EXPECT_EQ(apart(path.at(1.0), screwed(before, angle, pivot, axis, 0.07)), 0.0);
        for (const double time : {0.0, 0.25, 0.5, 0.9})
            EXPECT_LT(apart(path.at(time), screwed(before, time * angle, pivot, axis, time * 0.07)), 1e-9)
                << angle << " at " << time;
    }
}

TEST(ObjectPath, WithoutATurnOrWithAChangeOfScaleTheOriginGoesStraight) {
    const Similarity before{0.2, {1.0, 0.0, 0.0, 0.0}, {0.5, 0.1, -0.3}};
    Similarity after = before;
    after.translation += glm::dvec3(0.2, 0.0, -0.1);
    const ObjectPath slide({after, before, false});
    EXPECT_EQ(slide.angle(), 0.0);
    EXPECT_LT(glm::distance(slide.at(0.5).translation, before.translation + glm::dvec3(0.1, 0.0, -0.05)),
              1e-15);
    after.scale = 0.3;
    after.rotation = glm::angleAxis(1.0, glm::dvec3(0.0, 0.0, 1.0));
    const ObjectPath grows({after, before, false});
    EXPECT_NEAR(grows.angle(), 1.0, 1e-12);
    const Similarity middle = grows.at(0.5);
    EXPECT_LT(glm::distance(middle.translation, before.translation + glm::dvec3(0.1, 0.0, -0.05)), 1e-15);
    EXPECT_NEAR(middle.scale, 0.25, 1e-15);
    EXPECT_NEAR(std::abs(glm::dot(middle.rotation, glm::angleAxis(0.5, glm::dvec3(0.0, 0.0, 1.0)))), 1.0,
                1e-15);
}

TEST(ObjectPath, NoPointGoesFartherThanItsLongestWay) {
    const glm::dvec3 axis(0.0, 0.0, 1.0);
    const Similarity before{2.0, {1.0, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}};
    for (const double angle : {0.1, 1.0, 3.0}) {
        const ObjectPath path({screwed(before, angle, glm::dvec3(0.0), axis, 0.3), before, false});
        const glm::dvec3 point(0.7, 0.0, 0.0);
        double way = 0.0;
        for (int i = 0; i < 1000; ++i)
            way += glm::distance(path.at(0.001 * i).point(point), path.at(0.001 * (i + 1)).point(point));
        EXPECT_LE(way, path.longestWay(0.7)) << angle;
        EXPECT_GE(3.0 * way, path.longestWay(0.7)) << angle << ": and it is no idle bound";
    }
    Similarity after = before;
    after.scale = 2.5;
    EXPECT_NEAR(ObjectPath({after, before, false}).longestWay(0.7), 0.35, 1e-12) << "it grows";
}

TEST(PlaceProxy, TheNearestObjectIsTheOneWhoseBallIsNearest) {
    Scene scene = sceneOf(assets::box(glm::dvec3(0.1)));
    for (const double x : {0.3, 0.6})
        addShape(scene, assets::box(glm::dvec3(0.1)),
                 glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0.0, 0.0)));
    addShape(scene, assets::box(glm::dvec3(0.5)), glm::translate(glm::dmat4(1.0), glm::dvec3(0.6, 1.0, 0.0)));
    const TouchBench bench(scene);
    const ObjectMotions rest(bench.scene->restMotions);
    const auto nearest = [&](const glm::dvec3& hip) { return nearestObject(*bench.scene, rest, hip); };
    EXPECT_EQ(nearest({0.1, 0.0, 0.0}), 0);
    EXPECT_EQ(nearest({-5.0, 0.0, 0.0}), 0);
    EXPECT_EQ(nearest({0.2, 0.0, 0.0}), 1);
    EXPECT_EQ(nearest({0.32, 0.1, 0.0}), 1);
    EXPECT_EQ(nearest({0.7, -0.1, 0.0}), 2);
    EXPECT_EQ(nearest({0.6, 0.45, 0.0}), 3) << "its middle is farther, its ball is not";
    EXPECT_TRUE(isInsideAny(*bench.scene, rest, {0.3, 0.0, 0.0}));
    EXPECT_TRUE(isInsideAny(*bench.scene, rest, {0.6, 1.2, 0.0}));
    EXPECT_FALSE(isInsideAny(*bench.scene, rest, {0.15, 0.0, 0.0}));
}

/// A box of 0.1 m that rises at `speed` m/s under a hand which moves at `handSpeed`, 2 mm deep in the end: N.
double pushOfRisingBox(double speed, double handSpeed) {
    Scene scene = sceneOf(assets::box(glm::dvec3(0.1)));
    scene.materials[0].haptic.damping = {2.0f, HapticSource::Touchstone};
    scene.materials[0].haptic.stiffness = {500.0f, HapticSource::Touchstone};
    TouchBench bench(scene);
    bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
    constexpr int kTicks = 200;
    for (int i = -kTicks; i <= 0; ++i) {
        ObjectMotion& motion = bench.motions[0];
        motion.before = motion.workspaceFromObject;
        motion.workspaceFromObject.translation.y = speed * bench.dt * i;
        if (i == -kTicks)
            motion.before = motion.workspaceFromObject;
        bench.step({0.0, (i == -kTicks ? 0.06 : 0.048) + handSpeed * bench.dt * i, 0.0});
    }
    return bench.output.force.y;
}

TEST(MovingSurface, DampsTheVelocityAgainstItAndNoOther) {
    EXPECT_NEAR(pushOfRisingBox(0.0, 0.0), 1.0, 1e-3);
    EXPECT_NEAR(pushOfRisingBox(0.1, 0.1), 1.0, 1e-3) << "it goes along";
    EXPECT_NEAR(pushOfRisingBox(0.02, 0.0), 1.0 + 2.0 * 0.02, 1e-3) << "it comes";
    EXPECT_NEAR(pushOfRisingBox(0.0, -0.02), 1.0 + 2.0 * 0.02, 1e-3) << "the hand goes into it";
}

TEST(MovingSurface, ObjectsThatMoveElsewhereAreNotCountedAsNear) {
    // More than a tick can hold copies of, in a row that leads to the one that is touched.
    Scene scene =
        sceneOf(assets::box(glm::dvec3(0.02)), glm::translate(glm::dmat4(1.0), glm::dvec3(2.0, 0.0, 0.0)));
    for (int k = 1; k < 24; ++k)
        addShape(scene, assets::box(glm::dvec3(0.02)),
                 glm::translate(glm::dmat4(1.0), glm::dvec3(2.0 - 0.06 * k, 0.0, 0.0)));
    TouchBench bench(scene);
    bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
    double rise = 0.0;
    for (int i = 0; i < 100; ++i) {
        for (ObjectMotion& motion : bench.motions) {
            motion.before = motion.workspaceFromObject;
            motion.workspaceFromObject.translation.y += 1e-5;
        }
        rise += 1e-5;
        bench.step({2.0, (i == 0 ? 0.011 : 0.009) + rise, 0.0});
        ASSERT_FALSE(has(bench.output.flags, TickFlag::CandidatesFull)) << i;
    }
    EXPECT_GT(bench.output.contacts, 0u);
    EXPECT_NEAR(bench.output.penetration, 0.001, 1e-6);
}

} // namespace
} // namespace touchstone::test::object_path_test
