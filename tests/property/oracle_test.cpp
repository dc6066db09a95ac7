// Every tick against the oracle, which starts from our previous state. Where the two end apart, both ends
// must be valid rests: a surface may offer two, and a straight move in double may choose the other by a hair.

#include "tests/support/oracle.h"
#include "tests/support/strokes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace touchstone::test {
namespace {

TEST(Oracle, EveryTickOfAStrokeEndsWhereTheOracleEnds) {
    int compared = 0, diverged = 0;
    double worst = 0.0; // m, of those that ended at the same rest
    for (const StrokeCase& c : strokeCases()) {
        SCOPED_TRACE(c.name + " r " + std::to_string(c.radius) + " v " + std::to_string(c.speed));
        TouchBench bench(sceneOf(c.shape), strokeSettings(c));
        const HapticObject& object = *bench.scene->objects[0];
        const double unit = object.workspaceFromObject.scale;
        const long double radius =
            static_cast<long double>(std::max(c.radius / unit, 0.5 * kWeldTolerance * object.diagonal));
        const double tolerance = std::min(1e-6 * object.diagonal, 1e-6 / unit);
        bench.step({0.2, 0.0, 0.0});
        bench.moveTo(strokeHand(c, 0), 1.0);
        for (int i = 1; i < c.oracleTicks; ++i) {
            const LVec3 before(bench.state[0].proxy);
            bench.step(strokeHand(c, i));
            const LVec3 goal(object.workspaceFromObject.inverse().point(bench.output.hip));
            const OracleRest rest = oracleRest(object, before, goal, radius);
            ASSERT_TRUE(rest.settled) << "tick " << i;
            ++compared;
            const double apart = static_cast<double>(glm::length(rest.proxy - LVec3(bench.state[0].proxy)));
            if (apart <= tolerance) {
                worst = std::max(worst, apart * unit);
                continue;
            }
            ++diverged;
            std::vector<LVec3> touching;
            for (const BruteContact& contact :
                 bruteWithin(object, LVec3(bench.state[0].proxy), radius + 1e-9L))
                touching.push_back(contact.normal);
            EXPECT_LT(restResidual(touching, LVec3(bench.state[0].proxy), goal),
                      static_cast<long double>(tolerance))
                << "tick " << i << ": ours is no rest; the oracle's is " << apart * unit << " m away";
        }
    }
    RecordProperty("compared", compared);
    RecordProperty("diverged", diverged);
    std::printf("compared %d ticks: apart by at most %.2g m; %d divergences, each between two valid rests\n",
                compared, worst, diverged);
    EXPECT_LT(diverged, compared / 100);
}

} // namespace
} // namespace touchstone::test
