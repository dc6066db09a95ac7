// The tick's contract: it allocates nothing, whatever happens to it.

#include "tests/support/allocation_counter.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test {
namespace {

TEST(RealTime, TheTickAllocatesNothing) {
    for (const double radius : {0.0, 0.5e-3}) {
        HapticSettings settings;
        settings.proxyRadius = radius;
        settings.staticFriction = 0.5;
        settings.dynamicFriction = 0.4;
        TouchBench bench(sceneOf(assets::torus(0.06, 0.025, 90, 60)), settings);
        std::mt19937 random(5);
        std::normal_distribution<double> noise(0.0, 0.02);
        int touching = 0;
        const uint64_t before = allocationsOnThisThread();
        for (int i = 0; i < 4000; ++i) {
            const double a = 2e-3 * i;
            glm::dvec3 hip(0.084 * std::cos(a), 0.084 * std::sin(a), 0.01 * std::sin(3 * a));
            if (i % 10 == 9)
                hip += glm::dvec3(noise(random), noise(random), noise(random)); // jumps
            if (i % 501 == 500)
                hip.x = NAN;
            bench.step(hip);
            touching += bench.output.contacts > 0 ? 1 : 0;
        }
        const uint64_t after = allocationsOnThisThread();
        EXPECT_EQ(after - before, 0u);
        EXPECT_GT(touching, 1000);
    }
}

} // namespace
} // namespace touchstone::test
