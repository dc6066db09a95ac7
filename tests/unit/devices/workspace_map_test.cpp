#include "devices/device/mapped_device.h"
#include "devices/device/workspace_map.h"
#include "devices/simulated/told_hand.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace touchstone::workspace_map_test {
namespace {

constexpr double kTick = 1e-3;

DeviceSample at(const glm::dvec3& position) {
    DeviceSample sample;
    sample.position = position;
    sample.valid = true;
    return sample;
}

/// A hand that moves all the time, nowhere twice.
glm::dvec3 wandering(double t) {
    return {0.05 * std::sin(3.0 * t), 0.04 * std::cos(2.3 * t), 0.03 * std::sin(1.7 * t + 1.0)};
}

DeviceSample mapped(WorkspaceMap& map, const glm::dvec3& position, const WorkspaceWish& target,
                    double dt = kTick) {
    DeviceSample sample = at(position);
    map.apply(sample, target, dt);
    return sample;
}

TEST(WorkspaceMap, IsNothingUntilItIsAskedFor) {
    WorkspaceMap map;
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 x = wandering(i * kTick);
        const DeviceSample sample = mapped(map, x, {});
        ASSERT_EQ(sample.inWorkspace(), x) << "to the bit";
        ASSERT_EQ(sample.mapping.coupling, 1.0);
    }
}

TEST(WorkspaceMap, ZoomsAboutWhereTheHandIs) {
    WorkspaceMap map;
    const glm::dvec3 first{0.03, -0.02, 0.05}, second{-0.04, 0.01, 0.02};
    for (int i = 0; i < 2000; ++i)
        EXPECT_LT(glm::distance(mapped(map, first, {.zoom = 4.0}).inWorkspace(), first), 1e-15);
    EXPECT_EQ(map.mapping().workspaceFromDevice.scale, 4.0);
    // hip = first + 4 (x - first), then about that of the second with 0.5.
    const glm::dvec3 there = first + 4.0 * (second - first);
    EXPECT_LT(glm::distance(mapped(map, second, {.zoom = 4.0}).inWorkspace(), there), 1e-15);
    for (int i = 0; i < 2000; ++i)
        EXPECT_LT(glm::distance(mapped(map, second, {.zoom = 0.5}).inWorkspace(), there), 1e-15);
    EXPECT_LT(glm::distance(mapped(map, first, {.zoom = 0.5}).inWorkspace(), there + 0.5 * (first - second)),
              1e-15);
}

TEST(WorkspaceMap, GlidesFromZoomToZoom) {
    WorkspaceMap map;
    (void)mapped(map, glm::dvec3(0.01), {});
    double zoom = 1.0, elapsed = 0.0;
    for (; zoom < 10.0; elapsed += kTick) {
        const double now = mapped(map, glm::dvec3(0.01), {.zoom = 10.0}).mapping.workspaceFromDevice.scale;
        ASSERT_LE(now / zoom, std::exp(WorkspaceMap::kZoomRate * kTick) * (1 + 1e-15));
        ASSERT_GT(now, zoom);
        zoom = now;
    }
    EXPECT_NEAR(elapsed, std::log(10.0) / WorkspaceMap::kZoomRate, 2 * kTick);
    // A hand in motion: its HIP never moves faster than the hand times the larger zoom.
    glm::dvec3 before = mapped(map, wandering(0.0), {.zoom = 10.0}).inWorkspace();
    for (int i = 1; i < 5000; ++i) {
        const double wanted = (i / 700) % 2 == 0 ? 0.1 : 10.0;
        const glm::dvec3 hip = mapped(map, wandering(i * kTick), {.zoom = wanted}).inWorkspace();
        ASSERT_LE(glm::distance(hip, before),
                  10.0 * glm::distance(wandering(i * kTick), wandering((i - 1) * kTick)) + 1e-15);
        before = hip;
    }
}

TEST(WorkspaceMap, AClutchHoldsThePointAndGoesOnFromThere) {
    WorkspaceMap map;
    const double zoom = 2.5;
    map.begin({.zoom = zoom});
    double t = 0.0;
    glm::dvec3 hip = mapped(map, wandering(t), {.zoom = zoom}).inWorkspace();
    for (int turn = 0; turn < 1000; ++turn) {
        const glm::dvec3 held = hip;
        for (int i = 0; i < 20; ++i) {
            t += kTick;
            ASSERT_LT(
                glm::distance(mapped(map, wandering(t), {.zoom = zoom, .clutch = true}).inWorkspace(), held),
                1e-15);
        }
        const glm::dvec3 released = wandering(t);
        for (int i = 0; i < 20; ++i) {
            t += kTick;
            hip = mapped(map, wandering(t), {.zoom = zoom}).inWorkspace();
            ASSERT_LT(glm::distance(hip, held + zoom * (wandering(t) - released)), 1e-15);
        }
    }
}

TEST(WorkspaceMap, TheForceFadesOutAndComesBack) {
    WorkspaceMap map;
    (void)mapped(map, glm::dvec3(0.0), {});
    for (int i = 1; i <= 60; ++i)
        EXPECT_NEAR(mapped(map, glm::dvec3(0.0), {.clutch = true}).mapping.coupling,
                    std::max(0.0, 1.0 - i * kTick / 0.05), 1e-12);
    for (int i = 1; i <= 120; ++i)
        EXPECT_NEAR(mapped(map, glm::dvec3(0.0), {}).mapping.coupling, std::min(1.0, i * kTick / 0.1), 1e-12);
    // Let go before it is gone: from where it is.
    for (int i = 0; i < 20; ++i)
        (void)mapped(map, glm::dvec3(0.0), {.clutch = true});
    EXPECT_NEAR(mapped(map, glm::dvec3(0.0), {}, 0.01).mapping.coupling, 0.7, 1e-12);
}

TEST(WorkspaceMap, ZoomsWhileItIsClutched) {
    WorkspaceMap map;
    const glm::dvec3 hip = mapped(map, wandering(0.0), {}).inWorkspace();
    for (int i = 1; i < 1000; ++i)
        ASSERT_LT(glm::distance(
                      mapped(map, wandering(i * kTick), {.zoom = 8.0, .clutch = true}).inWorkspace(), hip),
                  1e-15);
    EXPECT_LT(glm::distance(mapped(map, wandering(1.0), {.zoom = 8.0}).inWorkspace(),
                            hip + 8.0 * (wandering(1.0) - wandering(0.999))),
              1e-15);
}

TEST(WorkspaceMap, CentresWithoutTouch) {
    WorkspaceMap map;
    (void)mapped(map, glm::dvec3(0.1), {});
    (void)mapped(map, glm::dvec3(-0.1), {.clutch = true});
    EXPECT_NE(mapped(map, glm::dvec3(0.0), {}).inWorkspace(), glm::dvec3(0.0));
    const glm::dvec3 place{0.01, 0.02, 0.03};
    map.centre(place);
    int unseen = 0;
    while (!mapped(map, glm::dvec3(0.0), {.zoom = 2.0}).valid)
        ++unseen;
    EXPECT_NEAR(unseen * kTick, WorkspaceMap::kCentring, 1.5 * kTick);
    EXPECT_LT(glm::distance(mapped(map, glm::dvec3(0.0), {.zoom = 2.0}).inWorkspace(), -place), 1e-15);
    EXPECT_LT(glm::distance(mapped(map, place, {.zoom = 2.0}).inWorkspace(), place), 1e-15);
}

TEST(WorkspaceMap, BearsAnything) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = INFINITY;
    WorkspaceMap map;
    (void)mapped(map, glm::dvec3(0.01), {});
    for (const double zoom : {kNan, -kInfinity, -1.0, 0.0}) {
        (void)mapped(map, glm::dvec3(0.01), {.zoom = zoom}, 10.0);
        EXPECT_EQ(map.mapping().workspaceFromDevice.scale, 1.0) << zoom;
    }
    for (const double dt : {kNan, -1.0, 10.0}) // as far as the longest step goes
        (void)mapped(map, glm::dvec3(0.01), {.zoom = kInfinity}, dt);
    EXPECT_NEAR(map.mapping().workspaceFromDevice.scale,
                std::exp(WorkspaceMap::kZoomRate * WorkspaceMap::kLongestStep), 1e-12);
    const auto goOn = [&](double zoom) {
        for (int i = 0; i < 200; ++i)
            (void)mapped(map, glm::dvec3(0.01), {.zoom = zoom}, 10.0);
    };
    goOn(kInfinity);
    EXPECT_EQ(map.mapping().workspaceFromDevice.scale, kMaxZoom);
    goOn(1e-9);
    EXPECT_EQ(map.mapping().workspaceFromDevice.scale, kMinZoom);
    // No sample: nothing is learned from it, and what was held is still held.
    const glm::dvec3 hip = mapped(map, glm::dvec3(0.01), {.zoom = 0.1}).inWorkspace();
    DeviceSample gone;
    gone.position = glm::dvec3(kNan);
    map.apply(gone, {.zoom = 0.1, .clutch = true}, kTick);
    EXPECT_FALSE(gone.valid);
    EXPECT_LT(glm::distance(mapped(map, glm::dvec3(0.5), {.zoom = 0.1, .clutch = true}).inWorkspace(), hip),
              1e-15);
}

TEST(MappedDevice, ItsSecondButtonIsTheClutch) {
    ToldHand told;
    told.next = at(glm::dvec3(0.0));
    MappedDevice device(told, 2.0, glm::dvec3(0.01));
    EXPECT_LT(glm::distance(device.sample(0.0).inWorkspace(), glm::dvec3(-0.01)), 1e-15);
    const uint64_t before = test::allocationsOnThisThread();
    told.next = at(glm::dvec3(0.03));
    const glm::dvec3 held = device.sample(0.001).inWorkspace();
    told.next.buttons = 1; // the first one is not
    EXPECT_EQ(device.sample(0.002).inWorkspace(), held);
    told.next.position = glm::dvec3(0.08);
    told.next.buttons = 2;
    EXPECT_LT(glm::distance(device.sample(0.003).inWorkspace(), held), 1e-15);
    told.next.buttons = 0;
    told.next.position = glm::dvec3(0.09);
    EXPECT_LT(glm::distance(device.sample(0.004).inWorkspace(), held + glm::dvec3(0.02)), 1e-15);
    EXPECT_EQ(test::allocationsOnThisThread(), before);
}

} // namespace
} // namespace touchstone::workspace_map_test
