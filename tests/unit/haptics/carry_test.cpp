// Objects that move among others: what they push, hold and leave behind.

#include "assets/shapes.h"
#include "haptics/settings/tick_flags.h"
#include "tests/support/touch_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchstone::test::carry_test {
namespace {

/// Boxes of 0.1 m with their middles at the given places.
struct Boxes : TouchBench {
    explicit Boxes(const std::vector<glm::dvec3>& middles) : TouchBench(sceneWith(middles)) {
        settings.stiffness = 500.0;
        motions.assign(scene->restMotions.begin(), scene->restMotions.end());
    }
    static Scene sceneWith(const std::vector<glm::dvec3>& middles) {
        Scene scene;
        for (const glm::dvec3& middle : middles) {
            const glm::dmat4 at = glm::translate(glm::dmat4(1.0), middle);
            if (scene.instances.empty())
                scene = sceneOf(assets::box(glm::dvec3(0.1)), at);
            else
                addShape(scene, assets::box(glm::dvec3(0.1)), at);
        }
        return scene;
    }
    /// One tick in which box `k` goes by `way` and turns by `angle` about z; the others stand.
    const HapticOutput& tick(const glm::dvec3& hip, size_t k, const glm::dvec3& way, double angle = 0.0) {
        for (ObjectMotion& motion : motions)
            motion.before = motion.workspaceFromObject;
        Similarity& pose = motions[k].workspaceFromObject;
        pose.translation += way;
        pose.rotation = glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)) * pose.rotation;
        return step(hip);
    }
    [[nodiscard]] glm::dvec3 seenFrom(size_t k) const {
        const Similarity& pose = motions[k].workspaceFromObject;
        return pose.scale * pose.inversePoint(output.proxy);
    }
};

TEST(MovingObstacles, ABoxThatComesInOneTickTakesTheProxyAlongWhicheverWayItComes) {
    for (const glm::dvec3& way : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0),
                                  glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)})
        for (const double speed : {0.16, 0.25, 0.4}) { // m in the tick
            const glm::dvec3 aside = glm::dvec3(way.y, way.z, way.x);
            Boxes bench({-0.2 * way, 0.5 * aside});
            bench.step(0.01 * aside);
            ASSERT_EQ(bench.output.contacts, 0u);
            bench.tick(0.01 * aside, 0, speed * way);
            EXPECT_FALSE(has(bench.output.flags, TickFlag::StartedInside));
            EXPECT_NEAR(glm::dot(bench.output.proxy, way), speed - 0.15, 1e-6);
            EXPECT_NEAR(glm::dot(bench.output.proxy, aside), 0.01, 1e-6);
            EXPECT_EQ(bench.output.object, 0);
        }
}

TEST(MovingObstacles, ABoxThatTurnsPushesAndNeverPassesTheProxy) {
    for (const double angle : {0.05, 0.3, 1.2}) {
        Boxes bench({{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}});
        const glm::dvec3 hip(0.045, 0.06, 0.0); // above a corner
        bench.step(hip);
        for (int i = 0; i < 3; ++i) {
            bench.tick(hip, 0, glm::dvec3(0.0), angle);
            const glm::dvec3 seen = bench.seenFrom(0);
            EXPECT_GE(std::max(std::abs(seen.x), std::abs(seen.y)), 0.05 - 1e-7) << angle << ", tick " << i;
            EXPECT_FALSE(has(bench.output.flags, TickFlag::StartedInside));
        }
    }
}

TEST(MovingObstacles, BetweenJawsTheProxyStaysWithOneAndIsFreeWhenTheyOpen) {
    Boxes bench({{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}});
    const glm::dvec3 hip(0.003, 0.01, 0.0);
    bench.step(hip);
    const auto close = [&](int ticks, double way) {
        for (int i = 0; i < ticks; ++i) {
            for (ObjectMotion& motion : bench.motions)
                motion.before = motion.workspaceFromObject;
            bench.motions[0].workspaceFromObject.translation.x += way;
            bench.motions[1].workspaceFromObject.translation.x -= way;
            bench.step(hip);
        }
    };
    close(49, 1e-3); // 1 mm to either side is left
    EXPECT_FALSE(has(bench.output.flags, TickFlag::Jammed));
    EXPECT_LE(std::abs(bench.output.proxy.x), 1e-3 + 1e-7);
    EXPECT_EQ(bench.output.object, 1) << "which pushes the hand";
    close(11, 1e-3); // 10 mm into each other
    EXPECT_TRUE(has(bench.output.flags, TickFlag::Jammed));
    EXPECT_NEAR(std::abs(bench.output.proxy.x), 0.01, 1e-6);
    EXPECT_NEAR(bench.output.proxy.y, 0.01, 1e-6);
    EXPECT_EQ(bench.output.contacts, 1u) << "the other is not felt";
    const int holder = bench.output.object;
    EXPECT_NEAR(bench.seenFrom(static_cast<size_t>(holder)).x, holder == 0 ? 0.05 : -0.05, 1e-6);
    close(11, -1e-3);
    EXPECT_FALSE(has(bench.output.flags, TickFlag::Jammed));
    EXPECT_LE(std::abs(bench.output.proxy.x), 1e-3 + 1e-7) << "between them again";
    close(20, -1e-3);
    EXPECT_EQ(bench.output.contacts, 0u);
    EXPECT_LT(glm::distance(bench.output.proxy, hip), 1e-9);
    EXPECT_EQ(bench.output.force, glm::dvec3(0.0));
}

TEST(MovingObstacles, AWedgeThatComesSlidesTheProxyOut) {
    // A box on its corner comes down on a hand that rests on another: the proxy goes aside, on top of it.
    Boxes bench({{0.0, -0.05, 0.0}, {0.005, 0.2, 0.0}});
    bench.tick({0.0, 0.05, 0.0}, 1, glm::dvec3(0.0), 0.25 * 3.141592653589793);
    for (int i = 0; i < 60; ++i)
        bench.tick({0.0, 0.05 - std::min(0.051, 1e-3 * i), 0.0}, 1, glm::dvec3(0.0));
    ASSERT_NEAR(bench.output.proxy.y, 0.0, 1e-6);
    const double tip = 0.2 - std::sqrt(0.005); // its lowest edge, at x = 0.005
    double down = 0.0;
    for (int i = 0; i < 150; ++i) {
        const double step = down + 1e-3 < tip - 1e-3 ? 1e-3 : 0.0;
        down += step;
        bench.tick({0.0, -0.001, 0.0}, 1, {0.0, -step, 0.0});
        ASSERT_FALSE(has(bench.output.flags, TickFlag::Jammed)) << i;
        EXPECT_GE(bench.output.proxy.y, -1e-7);
        // Beside both flanks of the wedge, which are at 45 degrees.
        const double height = bench.output.proxy.y - (tip - down),
                     aside = std::abs(bench.output.proxy.x - 0.005);
        EXPECT_LE(height, aside + 1e-6) << i;
    }
    EXPECT_GT(down, 0.1);
}

TEST(MovingObstacles, AJumpOntoTheHandEndsTheTouchAndOneElsewhereDoesNot) {
    for (const bool onto : {false, true}) {
        Boxes bench({{0.0, -0.05, 0.0}, {0.3, 0.0, 0.0}});
        bench.step({0.0, 0.01, 0.0});
        for (int i = 0; i < 5; ++i)
            bench.tick({0.0, -0.001, 0.0}, 1, glm::dvec3(0.0));
        ASSERT_NEAR(bench.output.force.y, 0.5, 1e-4);
        for (ObjectMotion& motion : bench.motions)
            motion.before = motion.workspaceFromObject;
        bench.motions[1].workspaceFromObject.translation =
            onto ? glm::dvec3(0.0, 0.0, 0.0) : glm::dvec3(0.0, 0.3, 0.0);
        bench.motions[1].jumped = true;
        bench.step({0.0, -0.001, 0.0});
        EXPECT_TRUE(has(bench.output.flags, TickFlag::ObjectJumped));
        EXPECT_EQ(has(bench.output.flags, TickFlag::StartedInside), onto);
        EXPECT_NEAR(bench.output.force.y, onto ? 0.0 : 0.5, 1e-4);
    }
}

/// Jaws that close in one tick on a proxy whose reference object is out of reach: it stays with one of them.
TEST(MovingObstacles, BetweenJawsThatAreNotItsReferenceItStaysWithOne) {
    Boxes bench({{0.0, -6.0, 0.0}, {-10.0, 0.0, 0.0}, {10.0, 0.0, 0.0}});
    const glm::dvec3 hip(0.0, 0.01, 0.0);
    const auto close = [&](double way) {
        for (ObjectMotion& motion : bench.motions)
            motion.before = motion.workspaceFromObject;
        bench.motions[1].workspaceFromObject.translation.x += way;
        bench.motions[2].workspaceFromObject.translation.x -= way;
        bench.step(hip);
    };
    bench.step(hip);
    close(10.0 - 0.05 - 0.01); // 10 mm to either side of the hand
    ASSERT_EQ(bench.state[0].reference, 0);
    ASSERT_EQ(bench.output.contacts, 0u);
    close(0.011);
    EXPECT_TRUE(has(bench.output.flags, TickFlag::Jammed));
    EXPECT_FALSE(has(bench.output.flags, TickFlag::CandidatesFull));
    EXPECT_FALSE(has(bench.output.flags, TickFlag::BudgetReached))
        << "no place is there, which is found soon";
    EXPECT_EQ(bench.state[0].jammed.count, 1u);
    EXPECT_NEAR(std::abs(bench.output.proxy.x), 1e-3, 1e-6) << "on the face of the other jaw";
}

/// A proxy that sticks goes with its surface by all of the way, at least as far as its depth in a tick.
TEST(MovingObstacles, AStickingProxyGoesAllTheWayWithItsSurface) {
    constexpr double kDepth = 1e-3;
    for (const double way : {1e-5, 3e-4, 8e-4}) {
        Boxes bench({{0.0, -0.05, 0.0}});
        bench.settings.staticFriction = bench.settings.dynamicFriction = 50.0;
        bench.moveTo({0.01, 0.002, 0.003}, 0.1);
        bench.moveTo({0.01, -kDepth, 0.003}, 0.1);
        ASSERT_EQ(bench.output.friction, FrictionState::Sticking);
        const glm::dvec3 proxy = bench.output.proxy;
        for (int i = 1; i <= 5; ++i) {
            bench.tick({0.01, -kDepth, 0.003}, 0, {way, 0.0, 0.0});
            EXPECT_EQ(bench.output.friction, FrictionState::Sticking);
            EXPECT_NEAR(bench.output.proxy.x, proxy.x + i * way, 1e-9) << way << " in tick " << i;
        }
    }
}

/// A surface that runs away under a proxy that sticks takes it along by what friction can hold: twice its
/// distance from the hand in a tick, also where a turn is divided into steps.
TEST(MovingObstacles, ASurfaceThatRunsAwayTakesAStickingProxyAlongAsFarAsFrictionHolds) {
    constexpr double kDepth = 1e-3, kAngle = 0.25; // rad in a tick, of which a step turns half
    for (const bool turns : {false, true}) {
        Boxes bench({{0.0, -0.05, 0.0}, {0.12, -0.05, 0.0}});
        bench.settings.staticFriction = bench.settings.dynamicFriction = 50.0;
        bench.moveTo({-0.03, 0.002, 0.003}, 0.1);
        bench.moveTo({-0.03, -kDepth, 0.003}, 0.1);
        ASSERT_EQ(bench.output.friction, FrictionState::Sticking);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 proxy = bench.output.proxy, hip = bench.output.hip;
            const double hold = 2.0 * glm::distance(proxy, hip), way = turns ? kAngle * 0.03 : 5e-3;
            for (ObjectMotion& motion : bench.motions)
                motion.before = motion.workspaceFromObject;
            Similarity& pose = bench.motions[0].workspaceFromObject;
            if (turns)
                pose.rotation = glm::angleAxis(kAngle, glm::dvec3(0.0, 1.0, 0.0)) * pose.rotation;
            else
                pose.translation.z += way;
            bench.step(hip);
            EXPECT_NEAR(glm::distance(bench.output.proxy, proxy), std::min(hold, way),
                        turns ? 0.02 * way : 1e-9)
                << turns << " in tick " << i;
            EXPECT_NEAR(bench.output.proxy.y, 0.0, 1e-6);
        }
    }
}

/// More facets meet at its tip than a solve has room for: it takes the proxy along as any other obstacle.
TEST(MovingObstacles, ASpikeOfFortyFacetsTakesTheProxyAlong) {
    constexpr int kFacets = 40;
    constexpr double kPi = 3.141592653589793, kSpike = 0.05, kSpikeRadius = 0.02, kWay = 1e-3;
    assets::Shape spike; // along +x, its tip at the origin
    const auto at = [](double angle) {
        return glm::vec3(glm::dvec3(-kSpike, kSpikeRadius * std::cos(angle), kSpikeRadius * std::sin(angle)));
    };
    for (int i = 0; i < kFacets; ++i) {
        const glm::vec3 a = at(2.0 * kPi * i / kFacets), b = at(2.0 * kPi * (i + 1) / kFacets);
        for (const glm::vec3& corner : {glm::vec3(0.0f), a, b, glm::vec3(at(0.0).x, 0.0f, 0.0f), b, a}) {
            spike.indices.push_back(static_cast<uint32_t>(spike.positions.size()));
            spike.positions.push_back(corner);
        }
    }
    for (const double beside : {0.0, 1e-8}) {
        Scene scene = Boxes::sceneWith({{0.0, -0.05, 0.0}});
        const glm::dvec3 hip(0.0, 0.01, 0.0);
        addShape(scene, spike, glm::translate(glm::dmat4(1.0), glm::dvec3(-0.03, hip.y + beside, 0.0)));
        TouchBench bench(scene);
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        bench.step(hip);
        ASSERT_EQ(bench.state[0].reference, 0);
        double tip = -0.03;
        for (int i = 0; i < 40; ++i) {
            for (ObjectMotion& motion : bench.motions)
                motion.before = motion.workspaceFromObject;
            bench.motions[1].workspaceFromObject.translation.x += kWay;
            tip += kWay;
            bench.step(hip);
            EXPECT_FALSE(has(bench.output.flags, TickFlag::StartedInside)) << i;
            const double behind = tip - bench.output.proxy.x,
                         aside = std::hypot(bench.output.proxy.y - hip.y - beside, bench.output.proxy.z);
            const double apothem = std::cos(kPi / kFacets) * kSpikeRadius / kSpike;
            EXPECT_TRUE(behind <= 1e-7 || aside >= apothem * behind - 1e-7)
                << behind << " behind the tip, " << aside << " beside it, tick " << i;
            if (std::abs(tip) > 1e-5) {
                EXPECT_EQ(bench.output.contacts > 0, tip > 0.0) << i;
            }
        }
    }
}

/// Two objects flush with each other that move together are one for friction.
TEST(MovingObstacles, FrictionGoesOverTheBorderOfTwoThatMoveTogether) {
    for (const FrictionMode law : {FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic}) {
        Boxes two({{-0.05, -0.05, 0.0}, {0.05, -0.05, 0.0}});
        TouchBench one(sceneOf(assets::box({0.2, 0.1, 0.1}),
                               glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.05, 0.0))));
        one.settings = two.settings;
        one.motions.assign(one.scene->restMotions.begin(), one.scene->restMotions.end());
        for (TouchBench* bench : {static_cast<TouchBench*>(&two), &one}) {
            bench->settings.friction = law;
            bench->settings.staticFriction = 0.6;
            bench->settings.dynamicFriction = 0.4;
        }
        double apart = 0.0, x = 0.001, dragged = 0.0;
        const auto tick = [&](double y, double along) {
            x += along;
            for (TouchBench* bench : {static_cast<TouchBench*>(&two), &one}) {
                for (ObjectMotion& motion : bench->motions) {
                    motion.before = motion.workspaceFromObject;
                    motion.workspaceFromObject.translation.z += 2e-6;
                }
                bench->step({x, y, 0.001});
            }
            apart = std::max(apart, glm::distance(two.output.force, one.output.force));
            dragged = std::max(dragged, std::abs(one.output.force.x));
        };
        for (int i = 0; i < 30; ++i)
            tick(0.002 - 1e-4 * i, 0.0);
        // Back and forth over the border. The proxy lags by up to 0.4 mm, so that it crosses now sliding, now
        // as it begins to slide. No number of steps is as long as a cone is wide: rounding decides nothing.
        constexpr double kStep = 1.0137e-5;
        for (int turn = 0; turn < 12; ++turn) {
            while (x > -0.39e-3 - 1e-5 * turn)
                tick(-0.001, -kStep);
            while (x < 0.001)
                tick(-0.001, kStep);
        }
        EXPECT_GT(dragged, 0.15);
        EXPECT_LT(apart, 1e-4) << settingValue(two.settings, "friction");
    }
}

/// More objects about the hand than a tick can follow: it says so, and touch begins anew.
TEST(MovingObstacles, AmongMoreObjectsThanThereIsRoomForTouchBeginsAnewAndSaysSo) {
    constexpr double kSize = 0.002;
    for (const int side : {6, 7}) { // 216 objects and 343; there is room for 256
        Scene scene;
        for (int i = 0; i < side * side * side; ++i) {
            const glm::dvec3 middle = 2.0 * kSize * glm::dvec3(i % side, i / side % side, i / side / side);
            const glm::dmat4 at = glm::translate(glm::dmat4(1.0), middle);
            if (scene.instances.empty())
                scene = sceneOf(assets::box(glm::dvec3(kSize)), at);
            else
                addShape(scene, assets::box(glm::dvec3(kSize)), at);
        }
        TouchBench bench(scene);
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        const glm::dvec3 hip = kSize * glm::dvec3(5.0, 5.0, 5.0); // between eight of them
        bench.step(hip);
        ASSERT_TRUE(bench.state[0].placed);
        for (ObjectMotion& motion : bench.motions) {
            motion.before = motion.workspaceFromObject;
            motion.workspaceFromObject.translation.x += 1.5 * kSize;
        }
        bench.step(hip);
        EXPECT_EQ(has(bench.output.flags, TickFlag::CandidatesFull), side == 7) << side;
    }
}

TEST(MovingObstacles, InASceneThatComesToRestNothingStaysPinched) {
    Boxes bench({{-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}});
    const glm::dvec3 hip(0.003, 0.01, 0.0);
    bench.step(hip);
    for (int i = 0; i < 110; ++i)
        bench.tick(hip, 1, {-1e-3, 0.0, 0.0});
    ASSERT_TRUE(has(bench.output.flags, TickFlag::Jammed));
    ASSERT_EQ(bench.state[0].jammed.count, 1u);
    bench.motions.clear();
    bench.step(hip);
    EXPECT_EQ(bench.state[0].jammed.count, 0u);
    EXPECT_FALSE(has(bench.output.flags, TickFlag::Jammed));
}

} // namespace
} // namespace touchstone::test::carry_test
