// The world moves: a box rises into a still hand, spins, slides; the workspace zooms in contact; a hand
// starts inside; objects overlap and touch.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test {
namespace {

void moveObjects(TouchBench& bench, const std::vector<Similarity>& now) {
    if (bench.motions.empty())
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
    for (size_t k = 0; k < now.size(); ++k) {
        bench.motions[k].before = bench.motions[k].workspaceFromObject;
        bench.motions[k].workspaceFromObject = now[k];
    }
}

TEST(MovingObjects, ABoxRisesIntoAStillHandAtEverySpeed) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            TouchBench bench(sceneOf(assets::box({0.1, 0.02, 0.1}, 2)), v.settings());
            const glm::dvec3 hand(0.01, 0.03, 0.02);
            bench.step(hand);
            Similarity pose = bench.scene->restMotions[0].workspaceFromObject;
            double risen = 0.0;
            while (risen < 0.035) {
                const double by = std::min(speed * 1e-3, 0.035 - risen);
                risen += by;
                pose.translation.y += by;
                moveObjects(bench, {pose});
                bench.step(hand);
                ASSERT_GE(bench.output.proxy.y, 0.01 + risen - 1e-9) << "the top went through the proxy";
            }
            EXPECT_NEAR(bench.output.force.y, 1000.0 * (bench.output.proxy.y - hand.y), 1e-6);
        }
}

TEST(MovingObjects, ASpinningAndSlidingBoxKeepsTheProxyOutside) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        TouchBench bench(sceneOf(assets::box({0.1, 0.04, 0.06}, 2)), v.settings());
        const glm::dvec3 hand(0.045, 0.0, 0.0);
        bench.step({0.12, 0.0, 0.0});
        bench.moveTo({0.08, 0.0, 0.0}, 0.1);
        Similarity pose = bench.scene->restMotions[0].workspaceFromObject;
        Gauge gauge;
        for (int i = 0; i < 3000; ++i) {
            pose.rotation = glm::angleAxis(2e-3 * i, glm::dvec3(0, 0, 1));
            pose.translation = glm::dvec3(0.002 * std::sin(0.01 * i), 0.0, 0.0);
            moveObjects(bench, {pose});
            bench.step(i < 350 ? glm::mix(glm::dvec3(0.08, 0, 0), hand, i / 350.0) : hand);
            gauge.take(bench.output);
            const glm::dvec3 inBox = glm::conjugate(pose.rotation) * (bench.output.proxy - pose.translation);
            const glm::dvec3 outside = glm::abs(inBox) - glm::dvec3(0.05, 0.02, 0.03);
            ASSERT_GE(std::max({outside.x, outside.y, outside.z}), -1e-9) << "tick " << i;
        }
        EXPECT_GT(gauge.measured().contactTicks, 500);
        EXPECT_EQ(gauge.measured().notFinite, 0);
    }
}

TEST(MovingObjects, AZoomInContactNeitherKicksNorLetsThrough) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        TouchBench bench(sceneOf(assets::sphere(0.05, 30, 30)), v.settings());
        bench.step({0.0, 0.08, 0.001});
        bench.moveTo({0.0, 0.049, 0.001}, 0.1);
        Similarity pose = bench.scene->restMotions[0].workspaceFromObject;
        glm::dvec3 last = bench.output.force;
        for (int i = 0; i < 1000; ++i) {
            pose.scale *= 1.0003; // doubles the sphere's size about its centre, and back
            if (i >= 500)
                pose.scale /= 1.0003 * 1.0003;
            moveObjects(bench, {pose});
            bench.step({0.0, 0.049, 0.001});
            ASSERT_GT(glm::length(bench.output.proxy), 0.99 * 0.5 * pose.scale);
            EXPECT_LT(glm::length(bench.output.force - last), 1000.0 * 0.05 * 0.0004) << "tick " << i;
            last = bench.output.force;
        }
    }
}

TEST(MovingObjects, OverlappingAndTouchingObjectsHoldTheirUnion) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}, 2));
            glm::dmat4 at(1.0);
            at[3] = glm::dvec4(0.08, 0.02, 0.0, 1.0); // overlaps the first, 20 mm higher
            addShape(scene, assets::box({0.1, 0.1, 0.1}, 2), at);
            at[3] = glm::dvec4(-0.1, 0.0, 0.0, 1.0); // touches the first face to face
            addShape(scene, assets::box({0.1, 0.1, 0.1}, 2), at);
            TouchBench bench(scene, v.settings());
            bench.step({-0.12, 0.1, 0.01});
            bench.moveTo({-0.12, 0.049, 0.01}, speed);
            bench.moveTo({0.02, 0.049, 0.01}, speed,
                         [&](const HapticOutput& out) { EXPECT_GE(out.proxy.y, 0.05); });
            EXPECT_NEAR(bench.output.proxy.x, 0.02, 1e-6) << "over the seam of two touching objects";
            bench.moveTo({0.06, 0.049, 0.01}, speed); // into the step
            EXPECT_LE(bench.output.proxy.x, 0.03);
            EXPECT_GE(bench.output.proxy.y, 0.05);
            EXPECT_LT(holdStill(bench, 50), 1e-9);
        }
}

TEST(MovingObjects, AHandThatStartsInsideFeelsNothingUntilItIsOut) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            TouchBench bench(sceneOf(assets::torus(0.06, 0.025, 72, 45)), v.settings());
            bench.step({0.06, 0.0, 0.001});
            EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
            bench.moveTo({0.06, 0.0, 0.05}, speed,
                         [](const HapticOutput& out) { EXPECT_EQ(glm::length(out.force), 0.0); });
            EXPECT_FALSE(has(bench.output.flags, TickFlag::StartedInside));
            bench.moveTo({0.06, 0.0, 0.024}, speed);
            EXPECT_GT(bench.output.force.z, 0.5);
        }
}

} // namespace
} // namespace touchstone::test
