// The tick's contract: it allocates nothing, whatever happens to it.

#include "tests/support/allocation_counter.h"
#include "tests/support/strokes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

namespace touchstone::test::real_time_test {
namespace {

TEST(RealTime, TheTickAllocatesNothing) {
    for (const double radius : {0.0, 0.5e-3}) {
        HapticSettings settings;
        settings.proxyRadius = radius;
        settings.staticFriction = 0.5;
        settings.dynamicFriction = 0.4;
        TouchBench bench(sceneOf(assets::torus(0.06, 0.025, 90, 60)), settings);
        RestlessHand hand;
        int touching = 0;
        const uint64_t before = allocationsOnThisThread();
        for (int i = 0; i < 4000; ++i) {
            bench.step(hand.next());
            touching += bench.output.contacts > 0 ? 1 : 0;
        }
        const uint64_t after = allocationsOnThisThread();
        EXPECT_EQ(after - before, 0u);
        EXPECT_GT(touching, 1000);
    }
}

} // namespace
} // namespace touchstone::test::real_time_test
