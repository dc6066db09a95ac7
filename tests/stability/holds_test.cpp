// Five hundred random holds: the force settles to a constant, and hand noise is not amplified inside one
// active set.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test {
namespace {

struct Body {
    std::string name;
    assets::Shape shape;
    double curvature; ///< m, least radius of curvature of the smooth shape; 0: flat faces
};

TEST(Holds, FiveHundredRandomHoldsSettleAndDoNotAmplifyTheHand) {
    const std::vector<Body> bodies{{"sphere1800", assets::sphere(0.05, 30, 30), 0.05},
                                   {"torus6480", assets::torus(0.06, 0.025, 72, 45), 0.025},
                                   {"box", assets::box({0.08, 0.09, 0.1}, 4), 0.0}};
    for (const Variant& v : allVariants()) {
        std::mt19937 random(9);
        std::normal_distribution<double> normal;
        int holds = 0, loud = 0, switched = 0;
        for (int trial = 0; holds < 500 && trial < 2000; ++trial) {
            const Body& body = bodies[static_cast<size_t>(trial) % bodies.size()];
            TouchBench bench(sceneOf(body.shape), v.settings());
            const glm::dvec3 direction =
                glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            // Tap along a random direction onto the surface, found by approaching until contact, then 1 mm
            // on.
            bench.step(0.15 * direction);
            const glm::dvec3 aim = body.name == "torus6480" ? 0.06 / std::hypot(direction.x, direction.y) *
                                                                  glm::dvec3(direction.x, direction.y, 0.0)
                                                            : glm::dvec3(0.0);
            glm::dvec3 hip = 0.15 * direction;
            const glm::dvec3 step = glm::normalize(aim - hip) * 5e-4;
            for (int i = 0; i < 400 && bench.output.contacts == 0; ++i)
                bench.step(hip += step);
            if (bench.output.contacts == 0)
                continue;
            for (int i = 0; i < 2; ++i)
                bench.step(hip += step);
            if (bench.output.penetration > 0.003)
                continue; // slid off an edge while approaching
            ++holds;
            for (int i = 0; i < 20; ++i)
                bench.step(hip);
            EXPECT_LT(holdStill(bench, 50), 1e-9) << body.name << " " << v.name() << " trial " << trial;
            // 5 µm of noise: the response inside one active set.
            const double depth = bench.output.penetration;
            const auto triangle = bench.output.triangle;
            double sum = 0.0, noise = 0.0;
            int count = 0, switches = 0;
            const glm::dvec3 rest = bench.output.force;
            const auto planes = bench.output.planeCount;
            for (int i = 0; i < 60; ++i) {
                const glm::dvec3 shake =
                    5e-6 / std::sqrt(3.0) * glm::dvec3(normal(random), normal(random), normal(random));
                bench.step(hip + shake);
                if (bench.output.triangle != triangle || bench.output.planeCount != planes) {
                    ++switches;
                    continue;
                }
                const glm::dvec3 change = bench.output.force - rest;
                sum += glm::dot(change, change);
                noise += 1000.0 * 1000.0 * glm::dot(shake, shake);
                ++count;
            }
            switched += switches > 0 ? 1 : 0;
            const double allowed =
                std::max(2.0, body.curvature > 0.0 ? 1.1 * body.curvature / (body.curvature - depth) : 2.0);
            if (count > 10 && std::sqrt(sum / noise) > allowed)
                ++loud;
        }
        EXPECT_EQ(holds, 500) << v.name();
        EXPECT_EQ(loud, 0) << v.name();
        std::printf("%s: %d holds, %d with plane switches under noise\n", v.name().c_str(), holds, switched);
    }
}

} // namespace
} // namespace touchstone::test
