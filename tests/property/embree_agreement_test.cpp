// What Embree hands us against brute force: no triangle near the proxy is ever left out.

#include "haptics/contact/candidates.h"
#include "haptics/contact/ray_floor.h"
#include "study/truth/brute_force.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace touchstone::test {

using namespace truth;

namespace {

TEST(Embree, AGatheredBallHoldsEveryTriangleThatMeetsIt) {
    for (const auto& shape : {assets::torus(0.06, 0.025, 72, 45), assets::sphere(0.05, 30, 30),
                              assets::box({1000.0, 0.1, 10.0}, 6)}) {
        const auto scene = compileHapticScene(sceneOf(shape), Similarity{});
        const HapticObject& object = *scene->objects[0];
        std::mt19937 random(11);
        std::uniform_real_distribution<double> in(-0.6, 0.6), size(-7.0, -0.5);
        CandidateCache cache;
        size_t found = 0;
        for (int trial = 0; trial < 300; ++trial) {
            glm::dvec3 centre(in(random), in(random), in(random));
            // Half of the balls stand on the surface, where it matters.
            if (trial % 2 == 0)
                centre = glm::dvec3(object.vertices[random() % (object.vertices.size() - 1)]);
            const double radius = std::pow(10.0, size(random));
            if (!cache.gather(scene->objects, scene->restMotions, scene->restSpheres, 0, centre, radius))
                continue;
            for (const BruteContact& contact :
                 bruteWithin(object, LVec3(centre), static_cast<long double>(radius))) {
                bool held = false;
                for (size_t i = 0; i < cache.count(); ++i)
                    held |= cache.item(i).index == contact.triangle;
                EXPECT_TRUE(held) << "triangle " << contact.triangle << " trial " << trial;
                ++found;
            }
        }
        EXPECT_GT(found, 100u);
    }
}

TEST(Embree, TheInsideTestAgreesWithTheClosedForm) {
    const auto scene = compileHapticScene(sceneOf(assets::torus(0.06, 0.025, 72, 45)), Similarity{});
    const HapticObject& object = *scene->objects[0];
    ASSERT_TRUE(object.closed);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> in(-0.1, 0.1);
    int inside = 0;
    for (int trial = 0; trial < 5000; ++trial) {
        const glm::dvec3 p(in(random), in(random), 0.4 * in(random));
        const double ring = std::hypot(p.x, p.y) - 0.06;
        const double depth = 0.025 - std::hypot(ring, p.z);
        if (std::abs(depth) < 2e-4)
            continue; // between the facets and the torus
        const bool found = insideObject(object, object.workspaceFromObject.inverse().point(p));
        EXPECT_EQ(found, depth > 0.0) << "depth " << depth;
        inside += found ? 1 : 0;
    }
    EXPECT_GT(inside, 500);
}

TEST(Embree, TheFloorRayMeetsTheSurfaceBetweenProxyAndHip) {
    TouchBench bench(sceneOf(assets::sphere(0.05, 30, 30)));
    bench.moveTo({0.0, 0.07, 0.003}, 0.1);
    bench.moveTo({0.0, 0.048, 0.003}, 0.1);
    ASSERT_GT(bench.output.contacts, 0u);
    const float hit = castFloorRay(*bench.scene, 0, bench.output.proxy, bench.output.hip);
    EXPECT_GT(hit, 0.0f);
    EXPECT_LT(hit, 1.0f);
}

} // namespace
} // namespace touchstone::test
