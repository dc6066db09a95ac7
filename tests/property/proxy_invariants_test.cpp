// What must hold at every tick, checked without a second solver: the proxy keeps its radius from every
// triangle, it never comes to the inside, and where it rests nothing lets it come nearer to the HIP.

#include "haptics/proxy/mesh_proxy.h"
#include "tests/support/brute_force.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace touchstone::test {
namespace {

struct Case {
    std::string name;
    assets::Shape shape;
    double tube;   ///< m, radius of the tube for a torus of ring 60 mm; 0: a body around the origin
    double reach;  ///< m, distance of the nominal surface from the centre or the ring
    double depth;  ///< m below the nominal surface
    double speed;  ///< m/s
    double radius; ///< m
    int ticks;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const double radius : {0.0, 0.5e-3})
        for (const double speed : {0.1, 1.0}) {
            all.push_back({"sphere1800", assets::sphere(0.05, 30, 30), 0.0, 0.05, 1e-3, speed, radius, 1500});
            all.push_back({"box", assets::box({0.08, 0.09, 0.1}, 4), 0.0, 0.05, 8e-3, speed, radius, 1500});
            all.push_back(
                {"torus6480", assets::torus(0.06, 0.025, 72, 45), 0.025, 0.025, 1e-3, speed, radius, 800});
            all.push_back(
                {"torus64800", assets::torus(0.06, 0.025, 180, 180), 0.025, 0.025, 1e-3, speed, radius, 120});
        }
    return all;
}

/// A stroke with taps: the hand runs over the shape and lifts off now and then.
glm::dvec3 hand(const Case& c, int tick) {
    const double a = tick * c.speed * 1e-3 / (c.tube > 0.0 ? 0.085 : c.reach);
    const double reach = c.reach - c.depth * (0.4 + 0.6 * std::cos(0.05 * tick));
    if (c.tube > 0.0) {
        const double v = 0.8 * a + 0.5;
        const double ring = 0.06 + reach * std::cos(v);
        return {ring * std::cos(a), ring * std::sin(a), reach * std::sin(v)};
    }
    const double tilt = 0.6 * std::sin(0.37 * a);
    return reach * glm::dvec3(std::cos(a) * std::cos(tilt), std::sin(a) * std::cos(tilt), std::sin(tilt));
}

TEST(ProxyInvariants, ClearanceSideAndRestHoldAtEveryTick) {
    for (const Case& c : cases()) {
        SCOPED_TRACE(c.name + " r " + std::to_string(c.radius) + " v " + std::to_string(c.speed));
        HapticSettings settings;
        settings.proxyRadius = c.radius;
        settings.forceShading = ShadingMode::Off;
        settings.friction = FrictionMode::Off;
        TouchBench bench(sceneOf(c.shape), settings);
        const HapticObject& object = *bench.scene->objects[0];
        const double unit = object.workspaceFromObject.scale;
        const double radius = std::max(c.radius / unit, 0.5 * kWeldTolerance * object.diagonal);
        bench.step({0.2, 0.0, 0.0});
        bench.moveTo(hand(c, 0), 1.0);
        int touching = 0;
        for (int i = 1; i < c.ticks; ++i) {
            bench.step(hand(c, i));
            const LVec3 p(bench.state[0].proxy);
            const BruteContact nearest = bruteNearest(object, p);
            ASSERT_GE(nearest.distance, static_cast<long double>(radius)) << "tick " << i;
            ASSERT_FALSE(insideObject(object, bench.state[0].proxy)) << "tick " << i;
            if (bench.output.contacts == 0) {
                EXPECT_LT(bench.output.penetration, 1e-9) << "free, so at the HIP; tick " << i;
                continue;
            }
            ++touching;
            // Everything within a hundredth of a micrometre counts as touching; what is left of the wish to
            // move is the error of the rest.
            std::vector<ConstraintPlane> planes;
            for (const BruteContact& contact :
                 bruteWithin(object, p, static_cast<long double>(radius + 1e-8 / unit)))
                planes.push_back({glm::dvec3(contact.normal), 0.0});
            const glm::dvec3 hip = object.workspaceFromObject.inverse().point(bench.output.hip);
            const SubGoal rest = nearestFeasible(hip - bench.state[0].proxy, planes);
            EXPECT_LT(glm::length(rest.point) * unit, 1e-6)
                << "tick " << i << " iterations " << bench.output.iterations;
            EXPECT_LT(glm::length(rest.point), 1e-6 * object.diagonal) << "tick " << i;
        }
        EXPECT_GT(touching, c.ticks / 4);
    }
}

} // namespace
} // namespace touchstone::test
