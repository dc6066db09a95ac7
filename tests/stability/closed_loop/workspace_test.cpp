// Clutch and zoom in closed loop, in contact: what the device is sent stays within its limits, and the energy
// that it gives is what docs/devices.md#workspace derives.

#include "devices/device/workspace_map.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/settings/tick_flags.h"
#include "tests/stability/closed_loop/loop_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace touchstone::test {
namespace {

static_assert(WorkspaceMap::kClutchOut == kForceRampOutTime && WorkspaceMap::kClutchIn == kForceRampInTime);
static_assert(WorkspaceMap::kCentring > kForceRampOutTime);

const Scene& floorScene() {
    static const Scene plane = sceneOf(assets::plane(0.4, 0.4));
    return plane;
}

/// A hand that holds the floor (y = 0) through a mapped device.
struct MappedLoop {
    explicit MappedLoop(double stiffness, const PlantParameters& plant = {},
                        PassivityMode passivity = PassivityMode::Observe)
        : limits(limitsOf(plant)),
          loop(floorScene(), wall(stiffness, passivity), plant, 1000.0, limitsOf(plant)) {
        loop.map = [this](DeviceSample& sample) { map.apply(sample, target(loop.time()), 1e-3); };
    }
    static HapticSettings wall(double stiffness, PassivityMode passivity) {
        HapticSettings settings = plainWall(stiffness);
        settings.passivity = passivity;
        return settings;
    }

    /// Ticks for so many s; what must always hold is held.
    void go(double seconds) {
        for (double t = 0.0; t < seconds - 5e-4; t += 1e-3) {
            const glm::dvec3 before = loop.plant().measured(), hip = loop.bench.output.hip;
            const glm::dvec3 command = loop.bench.output.command.force();
            const HapticOutput& output = loop.tick();
            const glm::dvec3 now = output.command.force();
            ASSERT_LE(glm::length(now), limits.maxForce);
            ASSERT_LE(glm::distance(now, command), limits.maxForceRate * 1e-3 * (1.0 + 1e-12));
            // The HIP moves by what the device moved times the zoom, or not at all. (Either zoom of the
            // tick.)
            if (started) {
                ASSERT_LE(glm::distance(output.hip, hip),
                          1.005 * output.zoom * glm::distance(loop.plant().measured(), before) + 1e-12);
            }
            started = true;
            maxJump = std::max(maxJump, glm::distance(now, command));
            maxBalance = std::max(maxBalance, output.energyBalance);
            maxNet = std::max(maxNet, net());
            maxForce = std::max(maxForce, glm::length(now));
            const double work = loop.plant().motorWork();
            maxInATick = std::max(maxInATick, work - lastWork);
            lastWork = work;
        }
    }
    /// J that the motors gave beyond what the device's friction took.
    [[nodiscard]] double net() const { return loop.plant().motorWork() - loop.plant().coulombLoss(); }

    DeviceLimits limits;
    WorkspaceMap map;
    std::function<WorkspaceWish(double)> target = [](double) { return WorkspaceWish{}; };
    LoopBench loop;
    bool started = false;
    double maxJump = 0.0, maxBalance = 0.0, maxNet = 0.0, maxForce = 0.0, maxInATick = 0.0, lastWork = 0.0;
};

/// Above the floor, down, and pressed with `force` by the hand's spring.
std::function<glm::dvec3(double)> pressing(double force, const PlantParameters& plant) {
    return [depth = force / plant.handStiffness](double t) {
        const double down = std::clamp((t - 0.3) / 0.4, 0.0, 1.0);
        return glm::dvec3(0.0131, 0.004 - down * (0.004 + depth), 0.0172);
    };
}

TEST(WorkspaceInClosedLoop, ZoomIsAStiffnessOfKTimesZoomAndNoMoreThanTheDeviceBears) {
    // dF / dx at the device, and the damper's dF / dv, which zoom leaves.
    const auto stiffnessAt = [](double zoom, double stiffness, double asked) {
        Scene scene = floorScene();
        scene.materials[0].haptic.stiffness.value = static_cast<float>(stiffness);
        HapticSettings settings = plainWall(asked);
        settings.passivity = PassivityMode::Off;
        TouchBench bench(scene, settings);
        bench.mapping.workspaceFromDevice.scale = zoom;
        (void)bench.step({0.0, 1e-3 / zoom, 0.0});
        const double low = bench.step({0.0, -1e-3 / zoom, 0.0}).force.y;
        const double high = bench.step({0.0, -2e-3 / zoom, 0.0}).force.y;
        return (high - low) / (1e-3 / zoom);
    };
    for (const double zoom : {0.1, 0.5, 1.0, 2.0, 5.0})
        EXPECT_NEAR(stiffnessAt(zoom, 600.0, 0.0), 600.0 * zoom, 1e-6 * 600.0 * zoom) << zoom;
    EXPECT_NEAR(stiffnessAt(10.0, 600.0, 0.0), 3500.0, 1e-3) << "DeviceLimits::maxStiffness";
    EXPECT_NEAR(stiffnessAt(10.0, 0.0, 600.0), 3500.0, 1e-3);
    EXPECT_NEAR(stiffnessAt(4.0, 0.0, 5000.0), 5000.0, 1e-3) << "asked for in so many words, and no more";
}

TEST(WorkspaceInClosedLoop, ZoomMovesTheStabilityLimitAsKTimesZoomSays) {
    // A bare device of 75 g and 1 N·s/m: stable up to 2b/T = 2000 N/m, as 600 N/m zoomed 3.3 times.
    const auto settles = [](double zoom, double maxStiffness) {
        PlantParameters plant = bareDevice(0.075, 1.0);
        DeviceLimits limits = noLimits();
        limits.maxStiffness = maxStiffness;
        Scene scene = floorScene();
        scene.materials[0].haptic.stiffness.value = 600.0f;
        LoopBench loop(scene, plainWall(0.0), plant, 1000.0, limits);
        loop.bench.mapping.workspaceFromDevice.scale = zoom;
        // A weight keeps it in the wall: what grows or decays is the swing about its rest.
        loop.weight = {0.0, -3.0, 0.0};
        const double rest = -3.0 / std::min(600.0 * zoom, maxStiffness);
        loop.hold({0.0, 0.003, 0.0}, {0.0, 0.98 * rest, 0.0});
        loop.release({0.0, 0.98 * rest, 0.0}, glm::dvec3(0.0));
        double early = 0.0, late = 0.0;
        for (int tick = 0; tick < 8000; ++tick) {
            (void)loop.tick();
            double& swing = tick < 500 ? early : late;
            if (tick < 500 || tick > 7500)
                swing = std::max(swing, std::abs(loop.plant().position().y - rest));
        }
        return late < early;
    };
    EXPECT_TRUE(settles(1.0, 1e9));
    EXPECT_TRUE(settles(3.2, 1e9)) << "1920 N/m";
    EXPECT_FALSE(settles(3.6, 1e9)) << "2160 N/m";
    EXPECT_TRUE(settles(10.0, 1900.0)) << "the limit holds it";
}

TEST(WorkspaceInClosedLoop, AClutchInContactFadesAndComesBackWithoutAJump) {
    PlantParameters plant;
    MappedLoop run(800.0, plant);
    const auto press = pressing(1.2, plant);
    bool held = false;
    run.target = [&](double) { return WorkspaceWish{.clutch = held}; };
    double aside = 0.0, deeper = 0.0;
    run.loop.intention = [&](double t) { return press(t) + glm::dvec3(aside, aside - deeper, 0.0); };
    run.loop.release(press(0.0), glm::dvec3(0.0));
    run.go(2.0);
    const double pressed = run.loop.bench.output.command.force().y;
    EXPECT_NEAR(pressed, 1.2 * 800.0 / (800.0 + plant.handStiffness), 0.05);
    run.maxJump = 0.0;
    for (int turn = 0; turn < 10; ++turn) {
        const double before = run.loop.bench.output.command.force().y;
        const glm::dvec3 hip = run.loop.bench.output.hip;
        held = true;
        run.go(0.06);
        EXPECT_EQ(run.loop.bench.output.command.force(), glm::dvec3(0.0));
        EXPECT_NEAR(run.loop.bench.output.force.y, before, 0.05) << "the point that is held goes on pressing";
        for (int i = 0; i <= 300; ++i) { // the hand goes 30 mm aside and up, and back
            aside = 0.015 * (1.0 - std::cos(2.0 * 3.141592653589793 * i / 300.0));
            run.go(1e-3);
            ASSERT_LT(glm::distance(run.loop.bench.output.hip, hip), 1e-12);
        }
        run.go(0.2);
        held = false;
        // Nothing held the hand back meanwhile: to press as before it must push as before.
        const double push = before / plant.handStiffness;
        for (int i = 1; i <= 100; ++i) {
            deeper += push / 100.0;
            run.go(1e-3);
        }
        run.go(0.9);
        EXPECT_NEAR(run.loop.bench.output.command.force().y, before, 0.1 * pressed);
    }
    // Full force in 50 ms is what the clutch takes away; the device's own motion in the wall comes on top.
    EXPECT_LT(run.maxJump, 1.3 * pressed / 50.0 + 800.0 * 0.1 * 1e-3);
    std::printf("  clutch: jump at most %.4f N, balance at most %.4f mJ, net at most %.4f mJ\n", run.maxJump,
                1e3 * run.maxBalance, 1e3 * run.maxNet);
    EXPECT_LT(run.maxBalance, kNoticedEnergy) << "what comes back was put in before";
    EXPECT_LT(run.maxNet, kNoticedEnergy);
}

TEST(WorkspaceInClosedLoop, LettingGoOfAClutchGivesBackWhatWasPutIn) {
    // Pressed in, clutched, let go, and the hand gives way: the wall throws it out, with no more than it
    // took.
    PlantParameters plant;
    for (const double zoom : {0.3, 1.0, 3.0}) {
        MappedLoop run(800.0, plant);
        const auto press = pressing(1.2, plant);
        bool held = false;
        double up = 0.0;
        run.target = [&](double) { return WorkspaceWish{.zoom = zoom, .clutch = held}; };
        run.map.begin({.zoom = zoom});
        run.loop.intention = [&](double t) { return press(t) + glm::dvec3(0.0, up, 0.0); };
        run.loop.release(press(0.0), glm::dvec3(0.0));
        run.go(2.0);
        held = true;
        run.go(0.2);
        held = false;
        for (int i = 0; i <= 300; ++i) {
            up = 1e-4 * i;
            run.go(1e-3);
        }
        EXPECT_EQ(run.loop.bench.output.contacts, 0u);
        std::printf("  let go at zoom %.1f: balance at most %.4f mJ, net at most %.4f mJ\n", zoom,
                    1e3 * run.maxBalance, 1e3 * run.maxNet);
        EXPECT_LT(run.maxBalance, kNoticedEnergy);
        EXPECT_LT(run.maxNet, kNoticedEnergy);
    }
}

TEST(WorkspaceInClosedLoop, ZoomInContactGivesWhatIsDerivedAndNoMore) {
    PlantParameters plant;
    const double stiffness = 800.0, force = 1.2;
    for (const PassivityMode passivity : {PassivityMode::Observe, PassivityMode::Control})
        for (const double other : {0.1, 0.3, 3.0, 10.0}) {
            MappedLoop run(stiffness, plant, passivity);
            const auto press = pressing(force, plant);
            double zoom = 1.0, up = 0.0;
            run.target = [&](double) { return WorkspaceWish{.zoom = zoom}; };
            run.loop.intention = [&](double t) { return press(t) + glm::dvec3(0.0, up, 0.0); };
            run.loop.release(press(0.0), glm::dvec3(0.0));
            run.go(2.0);
            const double pressed = run.loop.bench.output.command.force().y;
            run.maxJump = 0.0;
            for (int turn = 0; turn < 4; ++turn)
                for (const double wanted : {other, 1.0}) {
                    zoom = wanted;
                    run.go(1.5);
                }
            const double jump = run.maxJump;
            zoom = other;
            run.go(1.0);
            for (int i = 0; i <= 1000; ++i) { // and out, at the new zoom, by 30 mm
                up = 3e-5 * i;
                run.go(1e-3);
            }
            // What the wall holds in device terms, F l / (2 zoom), grows where the zoom falls.
            const double depth = pressed / stiffness, most = std::max(run.maxForce, pressed);
            const double derived = 0.5 * most * most / stiffness * std::max(0.0, 1.0 / other - 1.0);
            std::printf(
                "  zoom %4.1f %-8s jump at most %.4f N, balance at most %7.4f mJ, net at most %7.4f mJ, "
                "derived %7.4f mJ, depth %.2f mm\n",
                other, passivity == PassivityMode::Control ? "control" : "observe", jump,
                1e3 * run.maxBalance, 1e3 * run.maxNet, 1e3 * derived, 1e3 * depth);
            // The loop itself gives less than half of the controller's most, as without zoom.
            EXPECT_LT(run.maxBalance, derived + 0.5 * kMaxEnergy);
            EXPECT_LT(run.maxNet, derived + 0.5 * kMaxEnergy);
            if (passivity == PassivityMode::Observe) {
                EXPECT_GE(run.maxBalance, 0.7 * derived) << "the observer sees it";
                // A step of the sensor in the stiffest wall is the largest that there is.
                EXPECT_LT(jump, 0.01 + 3500.0 * plant.resolution) << "N in a tick";
            }
            if (passivity == PassivityMode::Control) {
                EXPECT_LE(run.maxBalance, kMaxEnergy + 2.0 * run.maxInATick);
                EXPECT_LE(run.maxNet, kMaxEnergy + 2.0 * run.maxInATick);
            }
        }
}

} // namespace
} // namespace touchstone::test
