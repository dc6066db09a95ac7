// The mouse as a hand that yields: it presses as hard as it was asked to, friction and bumps are seen as lag,
// and no wall that the program lets through makes it buzz.

#include "devices/mouse/mouse_device.h"
#include "devices/mouse/mouse_hand.h"
#include "haptics/query/surface_pick.h"
#include "haptics/safety/passivity.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::test {
namespace {

constexpr double kTick = 1e-3;

/// A plane at z = 0 seen from above, a pointer over it, and frames 33 ticks apart.
struct Pointer {
    explicit Pointer(const HapticSettings& settings, Scene scene = sceneOf(assets::plane(0.2, 0.2, 8, 8)))
        : bench(std::move(scene), settings) {
        press.force = 0.0;
        rest({0.0, 0.0}, 0.5);
        press.force = 0.6;
    }

    /// `at`: what the pointer is over, m.
    void frame(const glm::dvec2& at) {
        const glm::dvec3 eye(at.x, 0.5, -at.y), along(0.0, -1.0, 0.0);
        if (const auto pick = pickSurface(*bench.scene, {}, eye, along))
            hand.pointAt({pick->point, pick->normal, bench.settings.stiffness}, press);
        const HapticSettings& set = bench.settings;
        MouseGoal goal{.position = hand.goal(), .press = press.force, .stiffness = set.stiffness};
        if (set.staticFriction >= 0.0)
            goal.friction = set.staticFriction;
        if (set.friction == FrictionMode::Ho && set.dynamicFriction > 0.0)
            goal.grip = set.staticFriction / set.dynamicFriction;
        mouse.moveTo(goal);
        for (int i = 0; i < 33; ++i) {
            const HapticOutput& felt = bench.output;
            mouse.feel({.touching = felt.contacts > 0,
                        .hip = felt.hip,
                        .proxy = felt.proxy,
                        .force = felt.force,
                        .planes = {felt.planes.data(), felt.planeCount}});
            bench.step(mouse.sample(kTick * static_cast<double>(ticks++)).position);
            most = std::max(most, glm::length(felt.force));
            jump = std::max(jump, glm::length(bench.output.force - last));
            last = bench.output.force;
        }
    }
    void rest(const glm::dvec2& at, double seconds) {
        for (int i = 0; i < static_cast<int>(seconds / (33 * kTick)); ++i)
            frame(at);
        jump = 0.0;
    }

    TouchBench bench;
    MouseHand hand{glm::dvec3(0.0, 0.02, 0.0)};
    MouseDevice mouse;
    MousePress press;
    int ticks = 0;
    double most = 0.0; ///< N, the most so far
    double jump = 0.0; ///< N in a tick, the most since rest()
    glm::dvec3 last{0.0};
};

HapticSettings wall(double stiffness, double friction) {
    HapticSettings s;
    s.stiffness = stiffness;
    s.staticFriction = s.dynamicFriction = friction;
    return s;
}

TEST(MouseLoop, PressesWithTheForceItWasAskedFor) {
    for (const double stiffness : {200.0, 600.0, 2000.0})
        for (const double force : {0.2, 0.6, 3.0}) {
            Pointer pointer(wall(stiffness, 0.0));
            EXPECT_NEAR(pointer.bench.output.hip.y, MouseHand::kHover, 1e-6);
            pointer.press.force = force;
            pointer.rest({0.01, 0.02}, 1.0);
            EXPECT_NEAR(pointer.bench.output.force.y, force, 1e-3 * force) << stiffness << " N/m";
            EXPECT_LT(pointer.most, 1.0001 * force) << "not even when it lands";
        }
}

TEST(MouseLoop, LettingGoThrowsNobodyOut) {
    for (const double stiffness : {600.0, 3500.0}) {
        Pointer pointer(wall(stiffness, 0.0));
        pointer.press.force = 3.0;
        pointer.rest({0.01, 0.02}, 1.0);
        glm::dvec3 last = pointer.bench.output.hip;
        // The command holds for a tick while the hand comes out: k / 2 times the sum of the squared steps.
        const double held = 0.5 * 3.0 * MouseSmoothing{}.maxSpeed * kTick;
        pointer.press.force = 0.0;
        for (int i = 0; i < 30; ++i) {
            pointer.frame({0.01, 0.02});
            EXPECT_LE(glm::distance(last, pointer.bench.output.hip), 33 * kTick * MouseSmoothing{}.maxSpeed);
            EXPECT_LT(pointer.bench.output.energyBalance, held + kNoticedEnergy) << stiffness << " N/m";
            last = pointer.bench.output.hip;
        }
        EXPECT_EQ(pointer.bench.output.contacts, 0u);
    }
}

TEST(MouseLoop, FrictionIsSeenAsLag) {
    // Dragged at v the hand is 2 v / w behind; friction adds mu N / stiffness, and the proxy is where it is
    // felt.
    const MouseSmoothing smoothing;
    const auto lag = [&](double friction) {
        Pointer pointer(wall(600.0, friction));
        pointer.rest({0.0, 0.0}, 1.0);
        const double speed = 0.02;
        double x = 0.0;
        for (int i = 0; i < 60; ++i)
            pointer.frame({x = speed * 33 * kTick * i, 0.0});
        return x + 0.5 * speed * 33 * kTick - pointer.bench.output.hip.x; // a frame's mean goal
    };
    const double smooth = lag(0.0), rough = lag(0.5);
    EXPECT_NEAR(smooth, 2.0 * 0.02 / smoothing.frequency, 4e-4);
    EXPECT_NEAR(rough - smooth, 0.5 * 0.6 / smoothing.stiffness, 3e-4);
}

/// What friction holds is part of the press that was asked for, however rough the surface, sticking or
/// sliding. With coefficients above 1.3 it came to more.
TEST(MouseLoop, FrictionIsPartOfThePress) {
    for (const FrictionMode law : {FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic,
                                   FrictionMode::VelocityThreshold})
        for (const double stiffness : {600.0, 3500.0})
            for (const double coefficient : {0.3, 1.0, 2.0, 5.0})
                for (const double dynamic : {1.0, 0.2}) { // of the static one
                    HapticSettings settings = wall(stiffness, coefficient);
                    settings.dynamicFriction = dynamic * coefficient;
                    settings.friction = law;
                    Pointer pointer(settings);
                    pointer.rest({0.0, 0.0}, 0.5);
                    double x = 0.0;
                    const double start = pointer.bench.output.hip.x;
                    for (int i = 0; i < 45; ++i) // faster and faster, then evenly
                        pointer.frame({x += 1e-4 * std::min(i, 30), 0.0});
                    EXPECT_LT(pointer.most, 1.02 * 0.6) << stiffness << " N/m, " << coefficient << ", "
                                                        << dynamic << ", law " << static_cast<int>(law);
                    EXPECT_GT(pointer.bench.output.hip.x, start + 0.3 * x) << "it is dragged along";
                }
}

TEST(MouseLoop, AStiffWallNeitherBuzzesNorLetsThrough) {
    for (const double stiffness : {600.0, 3500.0})
        for (const double force : {0.5, 5.0}) {
            Pointer pointer(wall(stiffness, 0.3));
            pointer.press.force = force;
            pointer.rest({0.0, 0.0}, 2.0);
            for (int i = 0; i < 30; ++i)
                pointer.frame({0.0, 0.0});
            EXPECT_LT(pointer.jump, 1e-6) << stiffness << " N/m pressed with " << force << " N";
            EXPECT_GT(pointer.bench.output.proxy.y, 0.0);
        }
}

TEST(MouseHand, PointingPastTheModelStaysAsFarAwayAsItWas) {
    MouseHand hand(glm::dvec3(0.01, 0.02, 0.03));
    const ViewAxes view;
    const glm::dvec3 eye(0.0, 0.0, 0.4);
    hand.pointPast(view, eye, glm::normalize(glm::dvec3(0.1, -0.2, -1.0)));
    EXPECT_NEAR(hand.goal().z, 0.03, 1e-12);
    EXPECT_NEAR(hand.goal().x, 0.037, 1e-12);
    const glm::dvec3 before = hand.goal();
    hand.pointPast(view, eye, {0.0, 0.0, 1.0}); // away from what is seen
    EXPECT_EQ(hand.goal(), before);
}

} // namespace
} // namespace touchstone::test
