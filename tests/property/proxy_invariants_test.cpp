// What must hold at every tick, checked without a second solver: the proxy keeps its radius from every
// triangle, it never comes to the inside, and where it rests nothing lets it come nearer to the HIP.

#include "haptics/proxy/mesh_proxy.h"
#include "tests/support/brute_force.h"
#include "tests/support/strokes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace touchstone::test {
namespace {

TEST(ProxyInvariants, ClearanceSideAndRestHoldAtEveryTick) {
    for (const StrokeCase& c : strokeCases()) {
        SCOPED_TRACE(c.name + " r " + std::to_string(c.radius) + " v " + std::to_string(c.speed));
        TouchBench bench(sceneOf(c.shape), strokeSettings(c));
        const HapticObject& object = *bench.scene->objects[0];
        const double unit = object.workspaceFromObject.scale;
        const double radius = std::max(c.radius / unit, 0.5 * kWeldTolerance * object.diagonal);
        bench.step({0.2, 0.0, 0.0});
        bench.moveTo(strokeHand(c, 0), 1.0);
        int touching = 0;
        for (int i = 1; i < c.ticks; ++i) {
            bench.step(strokeHand(c, i));
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
