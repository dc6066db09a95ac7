// Hands and bodies: pushed, carried, recorded.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "engine/core/float_mode.h"
#include "haptics/tick/stepped_hand.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/eventually.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

namespace touchstone::test {

namespace {

/// m, > 0 outside of a cube of `side` about a body.
double outside(const body::BodyState& cube, double side, const glm::dvec3& point) {
    const glm::dvec3 p = glm::abs(cube.published.inversePoint(point)) - 0.5 * side;
    return std::max({p.x, p.y, p.z});
}

TEST(BodyTouch, AFreeBodyTakesTheHandsMomentum) {
    enterFloatMode();
    for (const BodyIntegrator integrator :
         {BodyIntegrator::Explicit, BodyIntegrator::SemiImplicit, BodyIntegrator::Implicit})
        for (const double stiffness : {600.0, 1000.0})
            for (const double speed : {0.05, 0.5, 1.0}) {
                BodyMaker maker;
                (void)maker.surface(0.0, 0.0);
                (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, 0.04, 0.05);
                Bodies bodies(maker);
                SteppedHand hand(*bodies.haptic, bodies.scene);
                HapticSettings settings;
                settings.gravity = 0.0;
                settings.integrator = integrator;
                settings.stiffness = stiffness;
                double impulse = 0.0, energy = 0.0, force = 0.0, gap = 1.0;
                for (int i = 0; i < 600; ++i) {
                    const double t = 1e-3 * i;
                    const HapticOutput& output = hand.tick(
                        settings, sampleAt({-0.03 + speed * std::min(t, 0.05 / speed), 0.0, 0.0}), t, 1e-3);
                    impulse -= 1e-3 * output.force.x;
                    energy = std::max(energy, output.energyBalance);
                    force = std::max(force, glm::length(output.command.force()));
                    gap = std::min(gap, outside(hand.world.bodies()->states()[0], 0.04, output.proxy));
                }
                const double momentum = 0.05 * hand.world.bodies()->states()[0].velocity.x;
                std::printf(
                    "free cube, %s, k %4.0f, %.2f m/s: momentum %.6f, impulse %.6f N s, force %.2f N, "
                    "given %+.4f mJ, gap %.2g m\n",
                    nameOf(integrator), stiffness, speed, momentum, impulse, force, 1e3 * energy, gap);
                EXPECT_NEAR(momentum, impulse, 1e-4 * impulse);
                EXPECT_GT(momentum, 0.0);
                EXPECT_LE(force, 8.5 + 1e-9);
                EXPECT_GT(gap, -1e-7);
                EXPECT_LE(energy, 1e-3);
            }
}

/// Two hands hold a body that is so light that the springs' rate is beyond the step's, one above its centre
/// and one below. Their forces cancel, their torques do not. What the springs hold at first bounds the spin
/// for ever.
TEST(BodyTouch, TwoHandsThatSqueezeALightBodyTurnItNoFasterThanTheirSpringsHold) {
    enterFloatMode();
    for (const BodyIntegrator integrator : {BodyIntegrator::SemiImplicit, BodyIntegrator::Implicit})
        for (const double mass : {1e-5, 1e-4, 1e-3}) {
            BodyMaker maker;
            (void)maker.surface(0.0, 0.0);
            (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, 0.04, mass);
            Bodies bodies(maker);
            const int object = static_cast<int>(bodies.world->objects()[0].object);
            constexpr double kStiffness = 1000.0, kForce = 5.0;
            const std::array<glm::dvec3, 2> touched{{{-0.02, 0.01, 0.0}, {0.02, -0.01, 0.0}}};
            const std::array<glm::dvec3, 2> along{{{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}};
            const body::BodyState& cube = bodies.at("cube");
            const double held = kForce * kForce / kStiffness; // J, of both springs
            double most = 0.0;
            for (int i = 0; i < 2000; ++i) {
                for (size_t h = 0; h < 2; ++h) { // hands that rest
                    const glm::dvec3 point = cube.pose.point(touched[h]);
                    const double force = kForce + kStiffness * glm::dot(along[h], touched[h] - point);
                    bodies.world->push(object, {.point = point,
                                                .force = std::max(force, 0.0) * along[h],
                                                .stiffness = kStiffness,
                                                .most = 8.5});
                }
                bodies.step(integrator, 0.0);
                ASSERT_TRUE(body::isSound(cube));
                most = std::max(most, body::kineticEnergy(bodies.world->masses()[0], cube));
            }
            std::printf("squeezed, %s, %g kg: %.3f mJ of %.3f\n", nameOf(integrator), mass, 1e3 * most,
                        1e3 * held);
            EXPECT_LE(most, held);
        }
}

/// A simulated device in a simulated hand (closed loop) that pushes a cube against a wall and lets it go, for
/// a minute. A sampled spring gives a fast hand energy by itself, at any wall that rests: so much is granted.
TEST(BodyTouch, ABodyPushedAgainstAWallGivesNoMoreEnergyThanAWall) {
    enterFloatMode();
    for (const BodyIntegrator integrator :
         {BodyIntegrator::Explicit, BodyIntegrator::SemiImplicit, BodyIntegrator::Implicit})
        for (const double speed : {0.05, 0.5, 1.0}) {
            double ofAWall = 0.0;
            for (const double mass : {0.0, 0.001, 0.05, 10.0}) {
                const double stiffness = speed == 0.5 ? 600.0 : 1000.0;
                BodyMaker maker;
                (void)maker.surface(0.3, 0.0);
                maker.box(maker.node("floor", {0.0, -0.07, 0.0}), {2.0, 0.1, 2.0}, 0);
                maker.box(maker.node("wall", {0.11, 0.0, 0.0}), {0.02, 0.4, 0.4}, 0);
                (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, 0.04, mass);
                Bodies bodies(maker);
                SteppedHand touch(*bodies.haptic, bodies.scene);
                ToldHand path;
                HandImpedance hand(path);
                HapticSettings settings;
                settings.integrator = integrator;
                settings.stiffness = stiffness;
                double energy = -1.0, force = 0.0, gap = 1.0, far = 0.0;
                size_t contacts = 0;
                for (int i = 0; i < 60'000; ++i) {
                    const double t = 1e-3 * i, phase = std::fmod(t, 6.0), length = 0.10;
                    const double way = phase < 3.0 ? std::min(phase * speed, length)
                                                   : std::max(length - (phase - 3.0) * speed, 0.0);
                    path.next = sampleAt({-0.04 + way, 0.002, 0.001});
                    const HapticOutput& output = touch.tick(settings, sampleWithLimits(hand, t), t, 1e-3);
                    hand.apply(output.command);
                    energy = std::max(energy, output.energyBalance);
                    if (mass == 0.0)
                        continue;
                    const body::BodyState& cube = touch.world.bodies()->states()[0];
                    force = std::max(force, glm::length(output.command.force()));
                    if (output.contacts > 0)
                        gap = std::min(gap, outside(cube, 0.04, output.proxy));
                    contacts += output.contacts > 0 ? 1 : 0;
                    far = std::max(far, cube.pose.position.x + 0.02);
                }
                if (mass == 0.0) {
                    ofAWall = energy;
                    std::printf("minute, at a wall, k %g, %.2f m/s: given %+.4f mJ\n", stiffness, speed,
                                1e3 * energy);
                    continue;
                }
                std::printf("minute, %s, %g kg, k %g, %.2f m/s: %zu ticks in contact, force %.2f N, given "
                            "%+.4f mJ, proxy %.2g m outside, face at %.5f m\n",
                            nameOf(integrator), mass, stiffness, speed, contacts, force, 1e3 * energy, gap,
                            far);
                EXPECT_LE(force, 8.5 + 1e-9);
                EXPECT_GT(gap, -1e-7);
                EXPECT_GT(contacts, 0u);
                if (integrator == BodyIntegrator::Explicit)
                    continue;
                EXPECT_LE(energy, ofAWall + 1e-3);
                EXPECT_LT(far, 0.1 + 5e-4);
            }
        }
}

/// Two hands at the sides of a cube of 100 g on a floor: they close, lift it by 10 cm, hold it and open.
TouchedScene cubeOnFloor() {
    BodyMaker maker;
    (void)maker.surface(0.6, 0.0);
    maker.box(maker.node("floor", {0.0, -0.07, 0.0}), {2.0, 0.1, 2.0}, 0);
    maker.json["materials"] = {
        {{"name", "rubber"},
         {"extensions",
          {{"TOUCHSTONE_materials_haptic",
            {{"stiffness", 600.0}, {"staticFriction", 0.6}, {"dynamicFriction", 0.6}}}}}}};
    maker.json["extensionsUsed"].push_back("TOUCHSTONE_materials_haptic");
    (void)addCube(maker, "cube", {0.0, 0.0, 0.0}, 0.04, 0.1);
    maker.json["meshes"][1]["primitives"][0]["material"] = 0;
    Bodies bodies(maker);
    TouchedScene made{bodies.scene, bodies.haptic, {}};
    made.identity.feltHash = feltHash(*made.haptic, *made.source);
    return made;
}

glm::dvec3 grip(double time, double side) {
    // From 5 cm away, since touch begins clear of the model.
    const double depth = time < 14.0 ? std::clamp(0.12 * (time - 0.5) - 0.006, -0.05, 0.006)
                                     : std::max(0.006 - 0.1 * (time - 14.0), -0.05);
    const double part = std::clamp((time - 1.5) / 1.0, 0.0, 1.0);
    const double lift = 0.1 * part * part * (3.0 - 2.0 * part);
    return {side * (0.02 - depth), lift, 0.0};
}

TEST(BodyTouch, TwoHandsPickUpACubeCarryItAndLetItFall) {
    const TouchedScene scene = cubeOnFloor();
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "pick.tsrec";
    RecordedServo rig({[](double t) { return at(grip(t, -1.0)); }, [](double t) { return at(grip(t, 1.0)); }},
                      {.rateHz = 1000.0, .ringCapacity = 1 << 15, .wantRealtime = false});
    rig.recorder.start(file, "test");
    rig.offer(scene);
    enterFloatMode();
    double held = 0.0, lowest = 1.0, highest = -1.0, end = 0.0;
    for (uint64_t i = 0; i < 15'000; ++i) {
        (void)rig.servo.step(i);
        const double t = 1e-3 * static_cast<double>(i);
        const double y = rig.servo.bodyPoses()->workspaceFromBody[0].position.y;
        if (std::abs(t - 3.0) < 5e-4)
            held = y;
        if (t > 3.0 && t < 13.9) {
            lowest = std::min(lowest, y);
            highest = std::max(highest, y);
        }
        end = y;
        if (i % 64 == 0)
            rig.drain();
    }
    rig.drain();
    rig.finish();
    std::printf("cube of 100 g: at %.3f mm of 100, in 10.9 s from %.3f to %.3f mm, dropped to %.3f mm\n",
                1e3 * held, 1e3 * lowest, 1e3 * highest, 1e3 * end);
    EXPECT_NEAR(held, 0.1, 0.003);
    EXPECT_GT(lowest, held - 1e-3);
    EXPECT_LT(highest, held + 1e-3);
    EXPECT_NEAR(end, 0.0, 1e-3);
    expectEqualReplay(replayOf(file, rig.scenes));
}

TEST(BodyTouch, ARecordingOfAServoThatRunsReplaysToTheLastBit) {
    const TouchedScene scene = touchedScene("blocks.glb");
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "blocks.tsrec";
    RecordedServo rig(
        [](double t) {
            return at(
                {0.0275 + 0.02 * std::sin(5.0 * t), std::max(0.06 - 0.1 * t, -0.018), 0.035 - 0.01 * t});
        },
        {.rateHz = 1000.0, .ringCapacity = 1 << 14, .wantRealtime = false});
    rig.recorder.start(file, "test");
    rig.offer(scene);
    rig.ticks(3500);
    rig.finish();
    uint64_t found = 0;
    for (const TickRecord& record : rig.records)
        found += record.found > 0 ? 1 : 0;
    std::printf("%zu ticks, %llu rounds of contacts apart, %zu ticks in contact\n", rig.records.size(),
                static_cast<unsigned long long>(found), rig.inContact());
    EXPECT_GT(found, 10u);
    EXPECT_GT(rig.inContact(), 10u);
    expectEqualReplay(replayOf(file, rig.scenes));
}

TEST(BodyTouch, AThousandSleepingBodiesAreStill) {
    BodyMaker maker;
    (void)maker.surface(0.5, 0.0);
    for (int i = 0; i < 1000; ++i) {
        const size_t ball = maker.node("ball", {0.05 * (i % 10), 0.05 * (i / 10 % 10), 0.05 * (i / 100)});
        maker.ball(ball, 0.01, 0);
        maker.motion(ball, {{"mass", 0.05}, {"gravityFactor", 0.0}});
    }
    Bodies bodies(maker);
    SteppedHand hand(*bodies.haptic, bodies.scene);
    HapticSettings settings;
    for (int i = 0; i < 6000 && hand.world.bodies()->awake() > 0; ++i)
        (void)hand.tick(settings, sampleAt({-1.0, -9.0, 0.0}), 1e-3 * i, 1e-3);
    ASSERT_EQ(hand.world.bodies()->awake(), 0u);
    for (int i = 0; i < 3; ++i)
        (void)hand.tick(settings, sampleAt({-1.0, -9.0, 0.0}), 10.0 + 1e-3 * i, 1e-3);
    EXPECT_TRUE(hand.world.still());
    const uint64_t before = allocationsOnThisThread();
    for (int i = 0; i < 100; ++i)
        (void)hand.tick(settings, sampleAt({-1.0, -9.0, 0.0}), 11.0 + 1e-3 * i, 1e-3);
    EXPECT_EQ(allocationsOnThisThread(), before);
}

TEST(BodyTouch, ASceneWithoutBodiesMakesNone) {
    const TouchedScene scene = touchedScene("box.glb");
    const uint64_t before = allocationsOnThisThread();
    {
        const WorldState world(scene.source, *scene.haptic);
        EXPECT_EQ(world.bodies(), nullptr);
        EXPECT_FALSE(world.collectsReactions());
        EXPECT_FALSE(world.moving());
    }
    EXPECT_EQ(allocationsOnThisThread(), before);
    RecordedServo rig([](double) { return at({0.0, 0.2, 0.0}); });
    rig.offer(scene);
    const auto threads = [] {
        size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/task"))
            ++count;
        return count;
    };
    const size_t without = threads();
    rig.servo.start();
    EXPECT_TRUE(eventually([&] { return threads() == without + 1; })) << "the servo alone";
    rig.servo.stop();
    rig.offer(touchedScene("blocks.glb"));
    rig.servo.start();
    EXPECT_TRUE(eventually([&] { return threads() == without + 2; })) << "and the finder of contacts";
    rig.servo.stop();
}

} // namespace

} // namespace touchstone::test
