// A hand that holds a body and moves it into others.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "engine/core/float_mode.h"
#include "engine/import/volume_file/volume_edits.h"
#include "engine/scene/physics.h"
#include "haptics/tick/stepped_hand.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

namespace touchstone::test {

namespace {

constexpr double kSide = 0.04; // m
constexpr double kStiffness = 600.0;

HapticSettings grasping(GraspMode mode = GraspMode::Touch) {
    HapticSettings settings;
    settings.stiffness = kStiffness;
    settings.grasp = mode;
    return settings;
}

/// A cube of 100 g on a floor.
BodyMaker massOnFloor() {
    BodyMaker maker;
    (void)maker.surface(0.6, 0.0);
    maker.box(maker.node("floor", {0.0, -0.07, 0.0}), {2.0, 0.1, 2.0}, 0);
    (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, kSide, 0.1);
    return maker;
}

/// Touches the cube's left face and then lifts it by `lift` within a second.
glm::dvec3 lifted(double time, double lift) {
    const double part = std::clamp(time - 0.5, 0.0, 1.0);
    return {-0.5 * kSide - std::max(0.03 - 0.1 * time, -0.0005), lift * part * part * (3.0 - 2.0 * part),
            0.0};
}

TEST(Grasp, AHandCarriesABodyAndFeelsItsWeight) {
    enterFloatMode();
    Bodies bodies(massOnFloor());
    SteppedHand hand(*bodies.haptic, bodies.scene);
    HapticSettings settings = grasping();
    double most = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const double t = 1e-3 * i;
        const HapticOutput& output = hand.tick(settings, sampleAt(lifted(t, 0.05)), t, 1e-3);
        most = std::max(most, glm::length(output.command.force()));
    }
    const body::BodyState& cube = hand.world.bodies()->states()[0];
    const double weight = 0.1 * 9.81;
    std::printf("held: force %.4f N of %.4f, hangs %.3f mm of %.3f, turned by %.2f degrees\n",
                -hand.output.force.y, weight, 1e3 * (0.05 - cube.pose.position.y), 1e3 * weight / kStiffness,
                glm::degrees(glm::angle(cube.pose.rotation)));
    EXPECT_EQ(hand.state.grasp.object, hand.output.object);
    EXPECT_NEAR(hand.output.force.y, -weight, 0.01 * weight);
    EXPECT_NEAR(cube.pose.position.y, 0.05 - weight / kStiffness, 5e-4);
    EXPECT_LE(most, 8.5 + 1e-9);
    // Let go: it falls back, and nothing pulls the hand.
    settings.grasp = GraspMode::Off;
    for (int i = 0; i < 1000; ++i) {
        const double t = 4.0 + 1e-3 * i;
        (void)hand.tick(settings, sampleAt(lifted(4.0, 0.05)), t, 1e-3);
    }
    EXPECT_EQ(hand.state.grasp.object, -1);
    EXPECT_EQ(hand.output.force, glm::dvec3(0.0));
    EXPECT_NEAR(hand.world.bodies()->states()[0].pose.position.y, 0.0, 1e-3);
}

TEST(Grasp, TheHandFeelsWhatTheHeldBodyMeets) {
    enterFloatMode();
    BodyMaker maker;
    (void)maker.surface(0.2, 0.0);
    maker.box(maker.node("wall", {0.10, 0.0, 0.0}), {0.02, 0.4, 0.4}, 0);
    (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, kSide, 0.1);
    (void)addCube(maker, "other", {0.0, 0.06, 0.0}, kSide, 0.1);
    Bodies bodies(maker);
    SteppedHand hand(*bodies.haptic, bodies.scene);
    HapticSettings settings = grasping();
    settings.gravity = 0.0;
    double most = 0.0;
    const auto go = [&](double& time, const glm::dvec3& from, const glm::dvec3& to, double seconds) {
        for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i, time += 1e-3) {
            const double part = std::min(i / (800.0 * seconds), 1.0);
            (void)hand.tick(settings, sampleAt(glm::mix(from, to, part)), time, 1e-3);
            most = std::max(most, hand.world.bodies()->states()[0].pose.position.x + 0.5 * kSide);
        }
    };
    double time = 0.0;
    const glm::dvec3 beside(-0.05, 0.0, 0.0), face(-0.5 * kSide + 0.0001, 0.0, 0.0);
    go(time, beside, face, 1.0);
    ASSERT_GE(hand.state.grasp.object, 0);
    // 0.09 - 0.02 = 0.07 m of way to the wall, and 8 mm beyond.
    go(time, face, face + glm::dvec3(0.078, 0.0, 0.0), 2.0);
    std::printf("wall: %.3f N of %.3f, the held cube's face at %.2f mm of 90\n", -hand.output.force.x,
                kStiffness * 0.008, 1e3 * most);
    EXPECT_NEAR(hand.output.force.x, -kStiffness * 0.008, 0.05 * kStiffness * 0.008);
    EXPECT_LT(most, 0.0905);
    // Up, against the other cube, which it carries along.
    go(time, face + glm::dvec3(0.078, 0.0, 0.0), face, 1.0);
    go(time, face, face + glm::dvec3(0.0, 0.05, 0.0), 1.0);
    EXPECT_GT(hand.world.bodies()->states()[1].pose.position.y, 0.085);
}

TEST(Grasp, AButtonTakesHoldAndLetsGo) {
    enterFloatMode();
    Bodies bodies(massOnFloor());
    SteppedHand hand(*bodies.haptic, bodies.scene);
    const HapticSettings settings = grasping(GraspMode::Button);
    const auto tick = [&](double t, uint32_t buttons) {
        DeviceSample sample = sampleAt(lifted(t, 0.0));
        sample.buttons = buttons;
        (void)hand.tick(settings, sample, t, 1e-3);
    };
    for (int i = 0; i < 500; ++i)
        tick(1e-3 * i, 0);
    EXPECT_EQ(hand.state.grasp.object, -1);
    EXPECT_GT(hand.output.contacts, 0u);
    for (int i = 500; i < 600; ++i)
        tick(1e-3 * i, 1);
    EXPECT_GE(hand.state.grasp.object, 0);
    tick(0.6, 0);
    EXPECT_EQ(hand.state.grasp.object, -1);
}

TEST(Grasp, WhatCannotMoveIsNotHeld) {
    BodyMaker maker = massOnFloor();
    const size_t block =
        maker.append("nodes", {{"name", "block"}, {"mesh", 1}, {"translation", {0.3, 0.0, 0.0}}});
    maker.json["scenes"][0]["nodes"].push_back(block);
    Bodies bodies(maker);
    SteppedHand hand(*bodies.haptic, bodies.scene);
    for (int i = 0; i < 600; ++i) {
        const double t = 1e-3 * i;
        (void)hand.tick(grasping(), sampleAt(glm::dvec3(0.3, 0.0, 0.0) + lifted(t, 0.0)), t, 1e-3);
    }
    EXPECT_GT(hand.output.contacts, 0u);
    EXPECT_EQ(hand.state.grasp.object, -1);
}

/// --loose: bodies of objects that the file says nothing about.
TEST(Grasp, AnyObjectOfALooseModelIsMovedIntoOthers) {
    enterFloatMode();
    BodyMaker maker;
    (void)addCube(maker, "held", {0.0, 0.0, 0.0}, kSide, 0.0);
    (void)addCube(maker, "other", {0.08, 0.0, 0.0}, kSide, 0.0);
    for (auto& node : maker.json["nodes"])
        node.erase("extensions"); // no collider, no motion
    LoadOptions options;
    options.edits = withLoose({});
    const ScenePtr scene = loadSceneFromMemory(maker.glb(), {}, options);
    ASSERT_NE(scene->physics, nullptr);
    EXPECT_TRUE(scene->physics->loose);
    std::string written = withChoices({}, *scene);
    EXPECT_TRUE(takeLoose(written)) << "a recording names the choice";
    EXPECT_EQ(loadSceneFromMemory(maker.glb(), {})->physics, nullptr);
    Bodies bodies(scene);
    SteppedHand hand(*bodies.haptic, bodies.scene);
    const auto x = [&](const std::string& name) {
        for (size_t b = 0; b < bodies.world->names().size(); ++b)
            if (bodies.world->names()[b] == name)
                return hand.world.bodies()->states()[b].pose.position.x;
        return std::numeric_limits<double>::quiet_NaN();
    };
    for (int i = 0; i < 3000; ++i) {
        const double t = 1e-3 * i;
        const double way = std::clamp(0.05 * (t - 1.0), 0.0, 0.06);
        (void)hand.tick(grasping(), sampleAt(lifted(t, 0.0) + glm::dvec3(way, 0.0, 0.0)), t, 1e-3);
    }
    EXPECT_GE(hand.state.grasp.object, 0);
    EXPECT_NEAR(x("held"), 0.06, 0.002) << "it has no weight and stays where it is put";
    EXPECT_GT(x("other"), 0.098);
    const double there = x("other");
    for (int i = 3000; i < 4000; ++i)
        (void)hand.tick(grasping(), sampleAt(lifted(3.0, 0.0) + glm::dvec3(0.06, 0.0, 0.0)), 1e-3 * i, 1e-3);
    EXPECT_NEAR(x("other"), there, 0.005) << "what was pushed comes to rest";
}

/// In the closed loop of device and hand, for a minute: carried and pressed against the floor. Without
/// gravity: the observer counts what a weight gives back on its way down as given.
TEST(Grasp, GivesTheHandNoEnergy) {
    enterFloatMode();
    for (const double mass : {0.001, 0.1, 1.0}) {
        BodyMaker maker;
        (void)maker.surface(0.6, 0.0);
        maker.box(maker.node("floor", {0.0, -0.07, 0.0}), {2.0, 0.1, 2.0}, 0);
        (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, kSide, mass);
        Bodies bodies(maker);
        SteppedHand touch(*bodies.haptic, bodies.scene);
        ToldHand path;
        HandImpedance hand(path);
        HapticSettings settings = grasping();
        settings.gravity = 0.0;
        double energy = -1.0, force = 0.0;
        for (int i = 0; i < 60'000; ++i) {
            const double t = 1e-3 * i;
            glm::dvec3 place = lifted(t, 0.0);
            if (t > 1.0)
                place += glm::dvec3(0.02 * std::sin(1.3 * (t - 1.0)),
                                    0.02 - 0.025 * std::cos(2.0 * (t - 1.0)) + 0.005, 0.0);
            path.next = sampleAt(place);
            const HapticOutput& output = touch.tick(settings, sampleWithLimits(hand, t), t, 1e-3);
            hand.apply(output.command);
            energy = std::max(energy, output.energyBalance);
            force = std::max(force, glm::length(output.command.force()));
        }
        std::printf("a minute with %g kg in the hand: given %+.4f mJ, force %.2f N\n", mass, 1e3 * energy,
                    force);
        EXPECT_GE(touch.state.grasp.object, 0);
        EXPECT_LE(force, 8.5 + 1e-9);
        EXPECT_LE(energy, 1e-3);
    }
}

TEST(Grasp, IsRecordedAndReplayedToTheLastBit) {
    Bodies bodies(massOnFloor());
    TouchedScene scene{bodies.scene, bodies.haptic, {}};
    scene.identity.feltHash = feltHash(*scene.haptic, *scene.source);
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "grasp.tsrec";
    RecordedServo rig([](double t) { return at(lifted(t, 0.05)); },
                      {.rateHz = 1000.0, .ringCapacity = 1 << 15, .wantRealtime = false});
    rig.recorder.start(file, "test");
    rig.servo.setSettings(grasping());
    rig.offer(scene);
    rig.steps(4000);
    rig.finish();
    EXPECT_GT(rig.servo.bodyPoses()->workspaceFromBody[0].position.y, 0.04);
    expectEqualReplay(replayOf(file, rig.scenes));
}

} // namespace

} // namespace touchstone::test
