// The world moves: a box rises into a still hand, spins, slides.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test::moving_objects_test {
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

} // namespace
} // namespace touchstone::test::moving_objects_test
