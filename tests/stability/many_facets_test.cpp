// Vertices of hundreds and thousands of facets: every ball about them holds all facets, and a tick has room
// for 64 contacts.

#include "haptics/settings/tick_flags.h"
#include "tests/support/fan.h"
#include "tests/support/touch_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>

namespace touchstone::test {
namespace {

constexpr double kDepth = 1e-3, kRim = 0.02;

/// Facets that all meet in the origin; their rim is higher by `rise`, m.
Scene fanScene(uint32_t facets, double rise) {
    return sceneOf(fan(facets, kRim, 0.0, rise));
}

HapticSettings plainSettings(double radius) {
    HapticSettings settings;
    settings.proxyRadius = radius;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    return settings;
}

/// A touch of a flat fan, kDepth deep, at x = `at`.
TouchBench touchOf(uint32_t facets, double radius, double at) {
    TouchBench bench(fanScene(facets, 0.0), plainSettings(radius));
    bench.moveTo({at, radius + 5e-3, 0.0}, 0.1);
    bench.moveTo({at, radius - kDepth, 0.0}, 0.1);
    return bench;
}

void expectAbove(const HapticOutput& output, double radius) {
    EXPECT_NEAR(output.proxy.x, output.hip.x, 1e-7);
    EXPECT_NEAR(output.proxy.y, radius, 1e-7);
    EXPECT_NEAR(output.proxy.z, output.hip.z, 1e-7);
    EXPECT_FALSE(has(output.flags, TickFlag::CandidatesFull));
}

class ManyFacets : public testing::TestWithParam<uint32_t> {
  protected:
    /// Calls test(radius) for a point, a small and a large sphere.
    template <class Test>
    void eachRadius(const Test& test) const {
        for (const double radius : {0.0, 0.5e-3, 4e-3}) {
            SCOPED_TRACE("radius " + std::to_string(radius));
            test(radius);
        }
    }
};

TEST_P(ManyFacets, AHandThatRestedOnTheirVertexIsFollowed) {
    eachRadius([&](double radius) {
        TouchBench bench = touchOf(GetParam(), radius, 0.0);
        for (int i = 0; i < 300; ++i)
            bench.step({0.0, radius - kDepth, 0.0});
        bench.moveTo({5e-3, radius - kDepth, 1e-3}, 0.1,
                     [&](const HapticOutput& output) { expectAbove(output, radius); });
    });
}

/// The fan goes round a pivot, and its vertex comes by under the hand.
TEST_P(ManyFacets, AHandAtRestStaysWhereTheirVertexComesBy) {
    constexpr double kWay = 0.01;
    eachRadius([&](double radius) {
        for (const double turning : {0.0, 1.0}) {
            SCOPED_TRACE(turning > 0.0 ? "turning" : "straight");
            TouchBench bench(fanScene(GetParam(), 0.0), plainSettings(radius));
            const auto poseAt = [&](double angle) {
                const glm::dquat turn = glm::angleAxis(turning * angle, glm::dvec3(0.0, 1.0, 0.0));
                const glm::dvec3 vertex = turning > 0.0
                                              ? kWay * glm::dvec3(std::sin(angle), 0.0, std::cos(angle) - 1.0)
                                              : glm::dvec3(kWay * angle, 0.0, 0.0);
                return Similarity{.scale = 1.0, .rotation = turn, .translation = vertex} *
                       bench.scene->restMotions[0].workspaceFromObject;
            };
            bench.motions = {{poseAt(0.5), poseAt(0.5), false}};
            bench.moveTo({0.0, radius + 5e-3, 0.0}, 0.1);
            bench.moveTo({0.0, radius - kDepth, 0.0}, 0.1);
            for (int i = 1; i <= 100; ++i) {
                bench.motions[0] = {poseAt(0.5 - 0.01 * i), bench.motions[0].workspaceFromObject, false};
                expectAbove(bench.step({0.0, radius - kDepth, 0.0}), radius);
            }
        }
    });
}

TEST_P(ManyFacets, AHandAtRestIsFollowedWhereFrictionIsSwitchedOff) {
    eachRadius([&](double radius) {
        TouchBench bench = touchOf(GetParam(), radius, 0.0);
        bench.settings.friction = FrictionMode::Zilles;
        bench.settings.staticFriction = bench.settings.dynamicFriction = 1.0;
        bench.step({0.0, radius - kDepth, 0.0});
        const glm::dvec3 hip(0.3e-3, radius - kDepth, 0.1e-3);
        bench.moveTo(hip, 0.1);
        for (int i = 0; i < 300; ++i)
            bench.step(hip);
        EXPECT_NEAR(bench.output.proxy.x, 0.0, 1e-7) << "it sticks";
        bench.settings.friction = FrictionMode::Off;
        for (int i = 0; i < 30; ++i)
            bench.step(hip);
        expectAbove(bench.output, radius);
    });
}

/// A wall holds the proxy on the vertex, and goes away.
TEST_P(ManyFacets, AHandAtRestIsFollowedWhereAnObstacleGoes) {
    eachRadius([&](double radius) {
        Scene scene = fanScene(GetParam(), 0.0);
        const glm::dmat4 facingBack =
            glm::rotate(glm::dmat4(1.0), 0.5 * std::numbers::pi, glm::dvec3(0.0, 0.0, 1.0));
        addShape(scene, assets::plane(0.02, 0.02),
                 glm::translate(glm::dmat4(1.0), glm::dvec3(radius + 1e-9, 0.0, 0.0)) * facingBack);
        TouchBench bench(scene, plainSettings(radius));
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        bench.moveTo({-1e-3, radius + 5e-3, 0.0}, 0.1);
        bench.moveTo({-1e-3, radius - kDepth, 0.0}, 0.1);
        const glm::dvec3 hip(0.5e-3, radius - kDepth, 0.0);
        bench.moveTo(hip, 0.1);
        for (int i = 0; i < 300; ++i)
            bench.step(hip);
        EXPECT_NEAR(bench.output.proxy.x, 0.0, 1e-7);
        Similarity away = bench.motions[1].workspaceFromObject;
        away.translation.y += 1.0;
        bench.motions[1] = {away, away, true};
        for (int i = 0; i < 60; ++i) // a quarter of what is left in each tick
            bench.step(hip);
        expectAbove(bench.output, radius);
    });
}

/// With all effects: friction holds the proxy back by mu times the depth, and no more.
TEST_P(ManyFacets, FrontsWithFrictionAndShadingAreFollowedAcrossTheirVertex) {
    eachRadius([&](double radius) {
        Scene scene = fanScene(GetParam(), 0.0);
        for (Material& material : scene.materials)
            material.haptic.sides = SideChoice::Front;
        HapticSettings settings;
        settings.proxyRadius = radius;
        settings.staticFriction = settings.dynamicFriction = 0.3;
        TouchBench bench(scene, settings);
        for (const double beside : {0.0, 1e-10, 1e-9, 5e-9}) {
            SCOPED_TRACE("beside by " + std::to_string(1e9 * beside) + " nm");
            bench.moveTo({-2e-3, radius + 5e-3, beside}, 0.1);
            bench.moveTo({-2e-3, radius - kDepth, beside}, 0.1);
            bench.moveTo({0.3e-3, radius - kDepth, beside}, 0.1); // the proxy is at the vertex
            bench.moveTo({2e-3, radius - kDepth, beside}, 0.1, [&](const HapticOutput& output) {
                EXPECT_NEAR(output.proxy.y, radius, 1e-7);
                EXPECT_LT(output.hip.x - output.proxy.x, 0.3 * kDepth + 1e-4);
                EXPECT_FALSE(has(output.flags, TickFlag::CandidatesFull));
            });
            bench.moveTo({2e-3, radius + 5e-3, beside}, 0.1);
        }
    });
}

/// Within some nanometres of the vertex the sphere touches all facets, most of them from beside their edges.
TEST_P(ManyFacets, NowhereBesideTheirVertexDoesAProxyStick) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> exponent(-12.0, -6.0), angle(0.0, 2.0 * std::numbers::pi);
    eachRadius([&](double radius) {
        for (int trial = 0; trial < 20; ++trial) {
            const double away = std::pow(10.0, exponent(random)), a = angle(random), b = angle(random);
            SCOPED_TRACE("trial " + std::to_string(trial));
            TouchBench bench = touchOf(GetParam(), radius, -2e-3);
            const glm::dvec3 beside(away * std::cos(a), radius - kDepth, away * std::sin(a));
            bench.moveTo(beside, 0.1);
            for (int i = 0; i < 3; ++i)
                expectAbove(bench.step(beside), radius);
            bench.moveTo(beside + glm::dvec3(2e-3 * std::cos(b), 0.0, 2e-3 * std::sin(b)), 0.1,
                         [&](const HapticOutput& output) { expectAbove(output, radius); });
        }
    });
}

/// A sphere that is pressed into a funnel touches all walls at once, at radius / cos(slope) above the vertex.
TEST_P(ManyFacets, AFunnelHoldsTheProxyInItsMiddle) {
    constexpr double kRise = 0.012;
    const double slope = std::atan(kRise / (kRim * std::cos(std::numbers::pi / GetParam())));
    eachRadius([&](double radius) {
        const double rest = radius / std::cos(slope);
        TouchBench bench(fanScene(GetParam(), kRise), plainSettings(radius));
        bench.moveTo({1e-3, rest + 5e-3, 0.5e-3}, 0.1);
        bench.moveTo({0.2e-3, rest - kDepth, -0.1e-3}, 0.1);
        bench.moveTo({-0.1e-3, rest - kDepth, 0.2e-3}, 0.1);
        for (int i = 0; i < 20; ++i)
            bench.step({-0.1e-3, rest - kDepth, 0.2e-3});
        EXPECT_NEAR(bench.output.proxy.x, 0.0, 1e-7);
        EXPECT_NEAR(bench.output.proxy.y, rest, 1e-7);
        EXPECT_NEAR(bench.output.proxy.z, 0.0, 1e-7);
        EXPECT_FALSE(has(bench.output.flags, TickFlag::CandidatesFull));
    });
}

INSTANTIATE_TEST_SUITE_P(, ManyFacets, testing::Values(24u, 100u, 300u, 1000u, 3000u),
                         [](const auto& facets) { return "Of" + std::to_string(facets.param); });

} // namespace
} // namespace touchstone::test
