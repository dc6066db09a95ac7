// The tick's contract: it allocates nothing, whatever happens to it, and what it gathers is bounded.

#include "tests/support/allocation_counter.h"
#include "tests/support/strokes.h"
#include "tests/support/touch_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>

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

/// Two plates side by side, 200 triangles on a square millimetre: within 0.3 radii of a proxy of 4 mm that
/// rests on them lie 6,900. Each move of a tick may gather what is near.
TEST(RealTime, ABigProxyOnADenseMeshGathersLittle) {
    constexpr double kWidth = 0.02, kRadius = 4e-3, kDepth = 1e-3;
    const assets::Shape plate = assets::plane(kWidth, kWidth, 200, 200);
    Scene scene = sceneOf(plate);
    addShape(scene, plate, glm::translate(glm::dmat4(1.0), {kWidth, 0.0, 0.0}));
    HapticSettings settings;
    settings.proxyRadius = kRadius;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    TouchBench bench(scene, settings);
    const double hip = kRadius - kDepth;
    bench.moveTo({0.0, 3.0 * kRadius, 0.0}, 0.1);
    bench.moveTo({0.0, hip, 0.0}, 0.1);
    size_t most = 0;
    int ticks = 0;
    bench.moveTo({kWidth, hip, 1e-3}, 0.1, [&](const HapticOutput& output) {
        ++ticks;
        if (ticks > 20) // the ball of the flight shrinks by halves
            most = std::max(most, bench.state[0].candidates.count());
        ASSERT_NEAR(output.proxy.y, kRadius, 1e-8) << "tick " << ticks;
        ASSERT_GT(output.contacts, 0u);
    });
    EXPECT_GT(ticks, 150);
    EXPECT_GT(most, 10u);
    EXPECT_LT(most, 400u);
}

} // namespace
} // namespace touchstone::test::real_time_test
