// Surfaces that give way [000]: force against the polynomial and the springs as closed forms.

#include "assets/shapes.h"
#include "engine/load/scene_loader.h"
#include "haptics/state/touch_checkpoint.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace touchstone::test::local_deformation_test {
namespace {

constexpr double kContact = 800.0, kGround = 400.0; // N/m
constexpr double kRadius = 0.02;                    // m

HapticMaterial::Field<float> stated(double value) {
    return {static_cast<float>(value), HapticSource::Touchstone};
}

/// The plane y = 0, which gives way.
Scene softPlane(double time, double linear = 0.0, double quadratic = -3.0) {
    Scene scene =
        sceneOf(assets::box({0.2, 0.02, 0.2}), glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.01, 0.0)));
    HapticMaterial& haptic = scene.materials[0].haptic;
    haptic.stiffness = stated(kContact);
    haptic.deformationRadius = stated(kRadius);
    haptic.deformationStiffness = stated(kGround);
    haptic.deformationLinear = stated(linear);
    haptic.deformationQuadratic = stated(quadratic);
    haptic.relaxationTime = stated(time);
    return scene;
}

TouchBench benchOf(const Scene& scene) {
    TouchBench bench(scene);
    bench.limits.maxForce = 50.0;
    bench.step({0.0, 0.01, 0.0});
    return bench;
}

void hold(TouchBench& bench, const glm::dvec3& hip, int ticks) {
    for (int i = 0; i < ticks; ++i)
        bench.step(hip);
}

TEST(LocalDeformation, AtRestContactAndGroundAreSpringsInARow) {
    TouchBench bench = benchOf(softPlane(0.05));
    for (const double depth : {0.001, 0.004, 0.009}) {
        hold(bench, {0.0, -depth, 0.0}, 1500);
        const double expected = kContact * kGround / (kContact + kGround) * depth;
        // The proxy keeps 0.14 um of room above the surface.
        EXPECT_NEAR(bench.output.force.y, expected, 1e-4);
        EXPECT_NEAR(bench.output.proxy.y, -expected / kGround, 1e-7) << "the probe lies in the dent";
        EXPECT_NEAR(glm::length(bench.output.force - glm::dvec3(0.0, bench.output.force.y, 0.0)), 0.0, 1e-9);
    }
}

TEST(LocalDeformation, ItYieldsAndRecoversInItsTime) {
    constexpr double kTime = 0.2, kDepth = 0.006;
    TouchBench bench = benchOf(softPlane(kTime));
    const double rate = (kContact + kGround) / (kGround * kTime); // 1/s, under load
    const double rest = kContact * kGround / (kContact + kGround) * kDepth;
    for (int i = 1; i <= 600; ++i) {
        bench.step({0.0, -kDepth, 0.0});
        const double t = 1e-3 * i;
        const double expected = rest + (kContact * kDepth - rest) * std::exp(-rate * t);
        ASSERT_NEAR(bench.output.force.y, expected, 0.01 * kContact * kDepth) << t;
    }
    const double depth = bench.state[0].dents.depth[0];
    for (int i = 1; i <= 400; ++i) {
        bench.step({0.0, 0.01, 0.0});
        EXPECT_EQ(bench.output.force, glm::dvec3(0.0));
        ASSERT_NEAR(bench.state[0].dents.depth[0], depth * std::exp(-1e-3 * i / kTime), 0.005 * depth) << i;
    }
}

/// Shapes that keep their centre: with a time of a minute a dent neither moves nor recovers while it is
/// felt; a hand that taps at a distance feels the polynomial.
TEST(LocalDeformation, ADentHasTheFormOfItsPolynomial) {
    struct Case {
        double linear, quadratic;
    };
    for (const Case& c : {Case{0.0, -3.0}, Case{-1.0, 0.0}, Case{0.0, -1.0}, Case{-2.0, 1.0}}) {
        const LocalDeformation law{.radius = kRadius, .linear = c.linear, .quadratic = c.quadratic};
        for (const double at : {0.0, 0.15, 0.4, 0.7, 0.95, 1.2}) {
            TouchBench bench = benchOf(softPlane(60.0, c.linear, c.quadratic));
            Dents& dents = bench.state[0].dents;
            dents.depth[0] = 0.003;
            dents.normal[0] = {0.0, 1.0, 0.0};
            dents.centre[0] = bench.scene->restMotions[0].workspaceFromObject.inversePoint(glm::dvec3(0.0));
            const double x = at * kRadius, height = 0.0041;
            hold(bench, {x, 0.001, 0.0}, 300); // until the filtered speed is 0
            const double depth = dents.depth[0];
            bench.step({x, -height, 0.0}); // at once: the dent is stationary
            const double there = at < 1.0 ? depth * law.shape(at) : 0.0;
            const double expected = kContact * (height - there);
            EXPECT_NEAR(bench.output.force.y, expected, 3e-4 * kContact * height) << c.linear << ' ' << at;
            // The gradient of the energy: towards the centre, where the dent is deeper.
            const double slope = at < 1.0 && at > 0.0 ? depth * law.slope(at) / kRadius : 0.0;
            EXPECT_NEAR(bench.output.force.x, expected * slope, 1e-3 * kContact * height) << at;
            EXPECT_NEAR(bench.output.height, -there, 2e-6);
        }
    }
}

TEST(LocalDeformation, APolynomialIsLimitedToADent) {
    for (const double linear : {-16.0, -3.0, 0.0, 4.0, 16.0})
        for (const double quadratic : {-16.0, -3.0, 0.0, 16.0}) {
            const LocalDeformation law{.radius = 1.0, .linear = linear, .quadratic = quadratic};
            EXPECT_EQ(law.shape(0.0), 1.0);
            EXPECT_EQ(law.shape(1.0), 0.0);
            EXPECT_EQ(law.shape(7.0), 0.0);
            for (int i = 0; i <= 100; ++i) {
                EXPECT_GE(law.shape(0.01 * i), 0.0);
                EXPECT_LE(law.shape(0.01 * i), 1.0);
            }
        }
}

/// A hand that strokes, taps and leaves gets back no more than it gave: E = sum F . dx of the hand's way.
TEST(LocalDeformation, GivesNoEnergy) {
    for (const double time : {0.0, 0.01, 0.15, 2.0}) {
        TouchBench bench = benchOf(softPlane(time));
        glm::dvec3 before(0.0, 0.01, 0.0), force(0.0);
        double given = 0.0, most = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const double t = 1e-3 * i;
            const glm::dvec3 hip(0.03 * std::sin(1.7 * t), 0.002 - 0.006 * std::sin(5.3 * t),
                                 0.02 * std::sin(2.9 * t + 1.0));
            bench.step(hip);
            given += glm::dot(0.5 * (force + bench.output.force), hip - before);
            most = std::max(most, given);
            before = hip;
            force = bench.output.force;
        }
        EXPECT_LT(most, 2e-5) << time;  // J
        EXPECT_LT(given, 1e-6) << time; // with time 0 it is a spring, which gives back all
    }
}

TEST(LocalDeformation, TheForceDoesNotJump) {
    TouchBench bench = benchOf(softPlane(0.3));
    glm::dvec3 force(0.0), before(0.0, 0.0005, 0.0);
    for (int i = 0; i < 30000; ++i) {
        const double t = 1e-3 * i;
        // Presses, leaves and crosses its own dents.
        const glm::dvec3 hip(0.025 * std::sin(2.1 * t), -0.002 - 0.0025 * std::sin(7.0 * t),
                             0.015 * std::sin(3.3 * t));
        bench.step(hip);
        if (i > 0) {
            // k times the way in a tick, and what a dent gives in one: N / (k' tau) k dt < 0.02 N.
            ASSERT_LT(glm::length(bench.output.force - force),
                      2.0 * kContact * glm::length(hip - before) + 0.03)
                << i;
        }
        before = hip;
        force = bench.output.force;
    }
}

TEST(LocalDeformation, ADeviceMakesNoDentBeyondItsForce) {
    TouchBench bench = benchOf(softPlane(0.05));
    bench.limits.maxForce = 1.0;
    hold(bench, {0.0, -0.05, 0.0}, 2000);
    EXPECT_NEAR(bench.state[0].dents.depth[0], 1.0 / kGround, 1e-6);
}

TEST(LocalDeformation, ASurfaceWithoutStiffnessIsNotPressedIn) {
    Scene scene = softPlane(0.1);
    scene.materials[0].haptic.deformationStiffness = {}; // then the ground is as stiff as the contact
    scene.meshes[0].stiffness.assign(scene.meshes[0].positions.size(), 0.0f);
    TouchBench bench = benchOf(scene);
    hold(bench, {0.0, -0.002, 0.0}, 10);
    EXPECT_EQ(bench.output.force, glm::dvec3(0.0));
    EXPECT_NEAR(bench.output.proxy.y, 0.0, 1e-6) << "it is 0 / 0 else";
}

TEST(LocalDeformation, SwitchedOffTheSurfaceIsHard) {
    TouchBench soft = benchOf(softPlane(0.1));
    Scene plain = softPlane(0.1);
    plain.materials[0].haptic.deformationRadius = {};
    TouchBench hard = benchOf(plain);
    EXPECT_FALSE(hard.scene->plan.deformation);
    ASSERT_EQ(setSetting(soft.settings, "deformation", "off"), "");
    hold(soft, {0.001, -0.004, 0.002}, 50);
    hold(hard, {0.001, -0.004, 0.002}, 50);
    EXPECT_EQ(soft.output.force, hard.output.force);
    EXPECT_FALSE(soft.state[0].dents.any());
}

TEST(LocalDeformation, ACheckpointHoldsTheDents) {
    TouchBench bench = benchOf(softPlane(0.1));
    hold(bench, {0.001, -0.004, 0.002}, 50);
    TouchCheckpoint checkpoint;
    takeCheckpoint(bench.state[0], checkpoint);
    DeviceState restored;
    ASSERT_TRUE(restoreCheckpoint(checkpoint.state(), bench.scene.get(), restored));
    EXPECT_EQ(restored.dents.depth, bench.state[0].dents.depth);
    EXPECT_EQ(restored.dents.centre, bench.state[0].dents.centre);
    restored.dents.object[0] = 1; // there is one object
    takeCheckpoint(restored, checkpoint);
    EXPECT_FALSE(restoreCheckpoint(checkpoint.state(), bench.scene.get(), restored));
}

TEST(LocalDeformation, ACornerGivesWayOnBothSides) {
    Scene scene = softPlane(0.02);
    addShape(scene, assets::box({0.02, 0.2, 0.2}),
             glm::translate(glm::dmat4(1.0), glm::dvec3(-0.06, 0.05, 0.0)));
    TouchBench bench(scene);
    bench.limits.maxForce = 50.0;
    bench.step({-0.03, 0.02, 0.0});
    for (int i = 0; i < 1000; ++i)
        bench.step({-0.03 - 2.4e-5 * i, 0.02 - 2.4e-5 * i, 0.0});
    hold(bench, {-0.054, -0.004, 0.0}, 500);
    const double expected = kContact * kGround / (kContact + kGround) * 0.004;
    EXPECT_EQ(bench.output.planeCount, 2u);
    EXPECT_NEAR(bench.output.force.x, expected, 1e-4 * expected);
    EXPECT_NEAR(bench.output.force.y, expected, 1e-4 * expected);
}

/// [000]'s doughnut of 64,800 triangles (ring 60 mm, tube 25 mm, about z), pressed at the top of its tube.
/// Under a hand at rest it is two springs in a row (k = 600, k' = 300 N/m); after it the surface is where it
/// was.
TEST(LocalDeformation, TheJellyDoughnutGivesWayMonotonicallyAndComesBack) {
    const ScenePtr scene = loadScene(std::filesystem::path(TOUCHSTONE_ASSETS) / "jelly_doughnut.glb");
    TouchBench bench(*scene);
    ASSERT_EQ(bench.scene->objects[0]->triangleCount(), 64800u);
    const auto above = [](double height) { return glm::dvec3(0.060, 0.0, 0.025 + height); };
    bench.step(above(0.01));
    double last = 0.0, dented = 0.0;
    for (const double depth : {0.00025, 0.0005, 0.001, 0.002, 0.004, 0.006, 0.008, 0.010, 0.012}) {
        hold(bench, above(-depth), 1500);
        const double force = bench.output.force.z;
        std::printf("pressed by %5.2f mm: %.4f N of %.4f\n", 1e3 * depth, force, 200.0 * depth);
        EXPECT_GT(force, last);
        EXPECT_NEAR(force, 200.0 * depth, 0.01 * 200.0 * depth + 200.0 * 2e-6);
        last = force;
        dented = std::max(dented, bench.state[0].dents.depth[0]);
    }
    EXPECT_GT(dented, 0.005) << "it was dented";
    hold(bench, above(0.02), 1500); // ten times the relaxation time
    double left = 0.0;
    for (const double depth : bench.state[0].dents.depth)
        left += depth;
    std::printf("1.5 s after the hand left the surface is at most %.5f mm from where it was\n", 1e3 * left);
    EXPECT_LE(left, 1e-4);
}

} // namespace
} // namespace touchstone::test::local_deformation_test
