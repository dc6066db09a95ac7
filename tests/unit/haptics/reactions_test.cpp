// The forces of the hands on the objects that they touch: equal and opposite, at the place of contact.

#include "assets/shapes.h"
#include "haptics/tick/haptic_step.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace touchstone::test::reactions_test {
namespace {

/// A floor at y = 0 and a wall at x = 0, an object each, of different materials.
Scene floorAndWall(float floor, float wall, float friction) {
    Scene scene = sceneOf(assets::box(glm::dvec3(0.2)), glm::translate(glm::dmat4(1.0), {0.0, -0.1, 0.0}));
    addShape(scene, assets::box(glm::dvec3(0.2)), glm::translate(glm::dmat4(1.0), {-0.1, 0.1, 0.0}));
    scene.materials.resize(2);
    scene.meshes[0].material = 0;
    scene.meshes[1].material = 1;
    for (size_t m = 0; m < 2; ++m) {
        scene.materials[m].haptic.stiffness.value = m == 0 ? floor : wall;
        scene.materials[m].haptic.staticFriction.value = friction;
        scene.materials[m].haptic.dynamicFriction.value = friction;
    }
    return scene;
}

HapticSettings bare(double radius = 0.0) {
    HapticSettings settings;
    settings.forceShading = ShadingMode::Off;
    settings.texture = TextureMode::Off;
    settings.proxyRadius = radius;
    return settings;
}

/// The god-object stands 0.17 µm off a wall, which adds 0.16 mN at 900 N/m. N; N·m.
constexpr double kForce = 2e-4, kTorque = 3e-6;

/// From free space into the corner.
void enter(TouchBench& bench, const glm::dvec3& to) {
    (void)bench.step({0.03, 0.03, 0.0});
    (void)bench.moveTo(to, 0.2);
    for (int i = 0; i < 300; ++i)
        (void)bench.step(to);
}

TEST(Reactions, EveryContactOfACornerGetsItsOwnLoad) {
    TouchBench bench(floorAndWall(300.0f, 900.0f, 0.0f), bare());
    bench.world.collectReactions(*bench.scene);
    const glm::dvec3 hip(-0.002, -0.003, 0.01);
    enter(bench, hip);
    const auto reactions = bench.world.reactions();
    ASSERT_EQ(reactions.size(), 2u);
    // F_i = k_i d_i along the normal of the wall; the proxy is at (0, 0, 0.01).
    const glm::dvec3 floor(0.0, -300.0 * 0.003, 0.0), wall(-900.0 * 0.002, 0.0, 0.0), place(0.0, 0.0, 0.01);
    EXPECT_NEAR(glm::distance(reactions[0].force, floor), 0.0, kForce);
    EXPECT_NEAR(glm::distance(reactions[1].force, wall), 0.0, kForce);
    EXPECT_NEAR(glm::distance(reactions[0].torque, glm::cross(place, floor)), 0.0, kTorque);
    EXPECT_NEAR(glm::distance(reactions[1].torque, glm::cross(place, wall)), 0.0, kTorque);
}

/// Two walls of one plain material are felt as one; on which object they are still counts.
TEST(Reactions, SoDoThoseOfOneMaterial) {
    Scene scene = floorAndWall(500.0f, 500.0f, 0.0f);
    scene.meshes[1].material = 0;
    TouchBench bench(scene, bare());
    bench.world.collectReactions(*bench.scene);
    enter(bench, {-0.002, -0.003, 0.0});
    const auto reactions = bench.world.reactions();
    EXPECT_NEAR(glm::distance(reactions[0].force, {0.0, -1.5, 0.0}), 0.0, kForce);
    EXPECT_NEAR(glm::distance(reactions[1].force, {-1.0, 0.0, 0.0}), 0.0, kForce);
}

/// Whatever the effects: the objects together get the opposite of what the hands get, as far as the device
/// can exert it, and an object that no hand touches gets nothing.
TEST(Reactions, AreTheOppositeOfTheHandsForces) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int single = 0, corner = 0;
    for (int turn = 0; turn < 60; ++turn) {
        Scene scene =
            floorAndWall(static_cast<float>(400.0 + 300.0 * unit(random)),
                         static_cast<float>(400.0 + 300.0 * unit(random)), turn % 3 == 0 ? 0.0f : 0.6f);
        scene.materials[0].haptic.damping.value = turn % 2 == 0 ? 2.0f : 0.0f;
        scene.materials[1].haptic.viscousFriction.value = turn % 5 == 0 ? 3.0f : 0.0f;
        HapticSettings settings = bare(turn % 4 == 0 ? 5e-4 : 0.0);
        settings.friction = static_cast<FrictionMode>(turn % 5);
        if (turn % 7 == 0)
            settings.forceShading = ShadingMode::TwoPass;
        TouchBench bench(scene, settings);
        bench.world.collectReactions(*bench.scene);
        if (turn % 6 == 0)
            bench.mapping.workspaceFromDevice.scale = 4.0;
        const double zoom = bench.mapping.workspaceFromDevice.scale;
        (void)bench.step(glm::dvec3(0.03, 0.03, 0.0) / zoom);
        for (int i = 0; i < 200; ++i) {
            const double a = 0.05 * i;
            const glm::dvec3 hip(0.006 * std::cos(a) + 1e-3 * unit(random), 0.006 * std::sin(1.3 * a) - 0.001,
                                 0.004 * std::sin(0.7 * a));
            const HapticOutput& output = bench.step(hip / zoom);
            const auto reactions = bench.world.reactions();
            const glm::dvec3 sum = reactions[0].force + reactions[1].force;
            const double magnitude = glm::length(output.force);
            const double exerted =
                magnitude > bench.limits.maxForce ? bench.limits.maxForce / magnitude : 1.0;
            ASSERT_NEAR(glm::distance(sum, -exerted * output.force), 0.0, 1e-12 * (1.0 + magnitude))
                << "turn " << turn << ", tick " << i;
            for (size_t k = 0; k < 2; ++k) {
                if (output.planeCount > 1 || output.object == static_cast<int>(k))
                    continue;
                ASSERT_EQ(reactions[k].force, glm::dvec3(0.0)) << "turn " << turn << ", tick " << i;
            }
            single += output.planeCount == 1 ? 1 : 0;
            corner += output.planeCount > 1 ? 1 : 0;
        }
    }
    EXPECT_GT(single, 1000);
    EXPECT_GT(corner, 500);
}

/// Coulomb's part of each contact follows its own load.
TEST(Reactions, FrictionIsSharedByTheLoads) {
    TouchBench bench(floorAndWall(400.0f, 400.0f, 0.5f), bare());
    bench.world.collectReactions(*bench.scene);
    enter(bench, {-0.001, -0.003, 0.0});
    for (int i = 0; i < 400; ++i) // along the line in which the walls meet
        (void)bench.step({-0.001, -0.003, 1e-4 * i});
    const auto reactions = bench.world.reactions();
    EXPECT_NEAR(reactions[0].force.z, 0.5 * 400.0 * 0.003, kForce);
    EXPECT_NEAR(reactions[1].force.z, 0.5 * 400.0 * 0.001, kForce);
    EXPECT_NEAR(reactions[0].force.y, -400.0 * 0.003, kForce);
    EXPECT_NEAR(reactions[1].force.x, -400.0 * 0.001, kForce);
}

TEST(Reactions, OfSeveralHandsAreSummed) {
    const TouchBench bench(floorAndWall(300.0f, 900.0f, 0.0f), bare());
    WorldState world;
    world.collectReactions(*bench.scene);
    std::array<DeviceState, 2> states;
    std::array<HapticOutput, 2> outputs;
    std::array<DeviceSample, 2> samples;
    for (DeviceSample& sample : samples)
        sample.valid = true;
    TickInput input;
    input.hands = samples;
    NoStopwatch none;
    for (int i = 0; i < 400; ++i) {
        samples[0].position = {0.03, std::max(-0.002, 0.02 - 1e-4 * i), 0.0};
        samples[1].position = {0.05, std::max(-0.004, 0.02 - 1e-4 * i), 0.01};
        hapticStep(*bench.scene, bench.settings, input, world, states, outputs, none);
    }
    EXPECT_NEAR(outputs[0].force.y, 0.6, kForce);
    EXPECT_NEAR(outputs[1].force.y, 1.2, kForce);
    EXPECT_NEAR(world.reactions()[0].force.y, -1.8, kForce);
    EXPECT_NEAR(world.reactions()[0].torque.z, -0.03 * 0.6 - 0.05 * 1.2, 2.0 * kTorque);
    EXPECT_EQ(world.reactions()[1].force, glm::dvec3(0.0));
    samples[0].valid = samples[1].valid = false;
    hapticStep(*bench.scene, bench.settings, input, world, states, outputs, none);
    EXPECT_EQ(world.reactions()[0].force, glm::dvec3(0.0)) << "of this tick alone";
}

} // namespace
} // namespace touchstone::test::reactions_test
