// Every effect in closed loop: a Phantom in a light grip, through the whole haptic step with its safety
// limits. What is judged is energy, by the true motion of the device and not by what its sensor sees.

#include "devices/simulated/simulated_hand.h"
#include "engine/load/scene_loader.h"
#include "haptics/settings/tick_flags.h"
#include "tests/stability/closed_loop/loop_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

namespace touchstone::test {
namespace {

/// What a run amounts to. J and N.
struct Account {
    double given = 0.0;      ///< by the motors, in all: negative where touch took energy
    double maxNet = 0.0;     ///< highest at any time of that less what the device's Coulomb friction took
    double maxBalance = 0.0; ///< highest that the observer saw
    double maxInATick = 0.0; ///< largest work of one tick
    double maxForce = 0.0;
    double lateSpeed = 0.0; ///< m/s, root mean square over the last fifth
    uint64_t contacts = 0, damped = 0, flagged = 0;
};

struct Case {
    std::string name;
    const Scene* scene;
    std::function<glm::dvec3(double)> path;
    HapticSettings settings;
    double seconds = 8.0;
    Fit fit = Fit::None;
    PlantParameters plant{};
    double rate = 1000.0;
};

Account run(Case c, PassivityMode passivity) {
    c.settings.passivity = passivity;
    LoopBench loop(*c.scene, c.settings, c.plant, c.rate, limitsOf(c.plant), c.fit);
    loop.intention = c.path;
    loop.release(c.path(0.0), glm::dvec3(0.0));
    Account account;
    const int ticks = static_cast<int>(c.seconds * c.rate);
    double before = 0.0, squares = 0.0;
    int late = 0;
    glm::dvec3 lastCommand(0.0);
    for (int tick = 0; tick < ticks; ++tick) {
        const HapticOutput& output = loop.tick();
        account.given = loop.plant().motorWork();
        account.maxNet = std::max(account.maxNet, account.given - loop.plant().coulombLoss());
        account.maxInATick = std::max(account.maxInATick, account.given - before);
        before = account.given;
        account.maxBalance = std::max(account.maxBalance, output.energyBalance);
        account.contacts += output.contacts > 0;
        account.damped += has(output.flags, TickFlag::EnergyDamped);
        account.flagged += has(output.flags, TickFlag::EnergyGiven);
        const glm::dvec3 command = output.command.force();
        account.maxForce = std::max(account.maxForce, glm::length(command));
        EXPECT_LE(glm::length(command), DeviceLimits{}.maxForce);
        EXPECT_LE(glm::distance(command, lastCommand), DeviceLimits{}.maxForceRate / c.rate * (1.0 + 1e-12));
        lastCommand = command;
        if (tick >= ticks - ticks / 5) {
            squares += glm::dot(loop.plant().velocity(), loop.plant().velocity());
            ++late;
        }
    }
    account.lateSpeed = std::sqrt(squares / late);
    return account;
}

void print(const std::string& name, const char* mode, const Account& a) {
    std::printf(
        "  %-44s %-8s given %+9.3f mJ, net at most %8.4f mJ, balance at most %8.4f mJ, in a tick %7.4f "
        "mJ, force %5.2f N, "
        "late %6.4f m/s, damped %llu, flagged %llu of %llu\n",
        name.c_str(), mode, 1e3 * a.given, 1e3 * a.maxNet, 1e3 * a.maxBalance, 1e3 * a.maxInATick, a.maxForce,
        a.lateSpeed, static_cast<unsigned long long>(a.damped), static_cast<unsigned long long>(a.flagged),
        static_cast<unsigned long long>(a.contacts));
}

std::function<glm::dvec3(double)> strokes(const Scene& scene, double speed, double depth) {
    StrokeOptions options;
    options.speed = speed;
    options.depth = depth;
    const auto path =
        std::make_shared<StrokePath>(strokeOver(scene, workspaceFromScene(scene, Fit::Workspace), options));
    return [path](double t) { return path->position(t); };
}

HapticSettings with(const char* name, const char* value, HapticSettings settings = {}) {
    EXPECT_EQ(setSetting(settings, name, value), "");
    return settings;
}

/// With the controller: however long it goes on, neither what the observer sees nor what the motors really
/// gave beyond the device's friction exceeds where the force has yielded altogether, but for the ticks in
/// which it is told.
void expectBounded(const std::string& name, const Account& a) {
    EXPECT_LE(a.maxBalance, kMaxEnergy + 2.0 * a.maxInATick) << name;
    EXPECT_LE(a.maxNet, kMaxEnergy + 2.0 * a.maxInATick) << name;
}

/// What every scene must show in both modes; ordinary touch is nowhere near the bound.
void expectOrdinary(const Case& c) {
    for (const PassivityMode mode : {PassivityMode::Observe, PassivityMode::Control}) {
        const Account a = run(c, mode);
        print(c.name, mode == PassivityMode::Control ? "control" : "observe", a);
        EXPECT_GT(a.contacts, 500u) << c.name;
        EXPECT_LT(a.maxBalance, 0.5 * kMaxEnergy) << c.name;
        EXPECT_LT(a.maxNet, 1e-3) << c.name;
        if (mode == PassivityMode::Control)
            expectBounded(c.name, a);
        else
            EXPECT_EQ(a.damped, 0u);
        EXPECT_LT(a.given, c.settings.friction != FrictionMode::Off && c.fit == Fit::Workspace ? -0.1 : 0.1)
            << c.name << ": friction takes";
    }
}

TEST(EffectsInClosedLoop, EveryMaterialTakesMoreThanItGives) {
    const ScenePtr swatches = loadScene(TOUCHSTONE_ASSETS "/swatches.glb");
    for (const char* texture : {"off", "law", "blinn", "minsky", "blinnMagnitude"})
        for (const char* friction : {"off", "zilles", "ho", "elastoplastic", "velocityThreshold"}) {
            Case c{.name = std::string("swatches, texture ") + texture + ", friction " + friction,
                   .scene = swatches.get(),
                   .path = strokes(*swatches, 0.15, 0.002),
                   .settings = with("friction", friction, with("texture", texture)),
                   .fit = Fit::Workspace};
            expectOrdinary(c);
        }
}

TEST(EffectsInClosedLoop, EveryShadingIsBounded) {
    const ScenePtr prism = loadScene(TOUCHSTONE_ASSETS "/prism_smooth.glb");
    const ScenePtr doughnut = loadScene(TOUCHSTONE_ASSETS "/doughnut.glb");
    for (const Scene* scene : {prism.get(), doughnut.get()})
        for (const char* shading : {"off", "twoPass", "projected", "direction", "bezier", "singleRound"}) {
            Case c{.name = std::string(scene == prism.get() ? "prism" : "doughnut") + ", shading " + shading,
                   .scene = scene,
                   .path = strokes(*scene, 0.2, 0.002),
                   .settings = with("forceShading", shading, with("stiffness", "1500")),
                   .fit = Fit::Workspace};
            expectOrdinary(c);
        }
}

/// The hand circles round a place while it presses into it.
std::function<glm::dvec3(double)> circles(const glm::dvec3& centre, double radius, double hertz,
                                          const glm::dvec3& u, const glm::dvec3& v) {
    return [=](double t) {
        const double angle = 6.283185307179586 * hertz * t;
        return centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
    };
}

TEST(EffectsInClosedLoop, EdgesAndCornersAreBounded) {
    // Round the convex edge of a box, over it and back; and in a corner of three planes.
    const Scene box = sceneOf(assets::box(glm::dvec3(0.06)));
    Scene corner = sceneOf(assets::plane(0.2, 0.2));
    const auto turned = [](const glm::dvec3& axis) {
        return glm::rotate(glm::dmat4(1.0), 1.5707963267948966, axis);
    };
    addShape(corner, assets::plane(0.2, 0.2), turned({0, 0, -1})); // normal +x
    addShape(corner, assets::plane(0.2, 0.2), turned({1, 0, 0}));  // normal +z
    for (const char* friction : {"off", "zilles"})
        for (const double hertz : {1.0, 6.0}) {
            Case edge{.name = std::string("box edge, friction ") + friction + ", " + std::to_string(hertz) +
                              " Hz",
                      .scene = &box,
                      .path = circles({0.0305, 0.0305, 0.004}, 0.004, hertz, {1, 0, 0}, {0, 1, 0}),
                      .settings = with("stiffness", "1500", with("friction", friction))};
            edge.settings.staticFriction = 0.5;
            edge.settings.dynamicFriction = 0.3;
            Case three = edge;
            three.name = "corner" + edge.name.substr(8);
            three.scene = &corner;
            three.path = circles({0.0005, 0.0005, 0.0005}, 0.003, hertz, glm::normalize(glm::dvec3(1, -1, 0)),
                                 glm::normalize(glm::dvec3(1, 1, -2)));
            for (const Case& c : {edge, three})
                expectOrdinary(c);
        }
}

TEST(EffectsInClosedLoop, TheControllerKeepsAWallBeyondTheLimitBounded) {
    const Scene plane = sceneOf(assets::plane(0.2, 0.2));
    int beyond = 0;
    for (const double rate : {1000.0, 4000.0})
        for (const int delay : {0, 1})
            for (const double stiffness : {1e4, 3e4, 1e5}) {
                Case c{.name = std::to_string(static_cast<int>(stiffness)) + " N/m at " +
                               std::to_string(static_cast<int>(rate)) + " Hz, delay " + std::to_string(delay),
                       .scene = &plane,
                       .path =
                           [](double t) {
                               return glm::dvec3(
                                   0.01, t < 0.5 ? 0.003 : std::max(-0.004, 0.003 - 0.05 * (t - 0.5)), 0.02);
                           },
                       .settings = plainWall(stiffness),
                       .seconds = 20.0,
                       .rate = rate};
                c.plant.delay = delay;
                const Account wild = run(c, PassivityMode::Observe), tame = run(c, PassivityMode::Control);
                print(c.name, "observe", wild);
                print(c.name, "control", tame);
                expectBounded(c.name, tame);
                if (wild.maxNet < 0.02)
                    continue;
                ++beyond;
                EXPECT_GT(wild.maxNet, 10.0 * tame.maxNet) << c.name;
                EXPECT_GT(wild.lateSpeed, 0.03) << c.name;
                EXPECT_LT(tame.lateSpeed, 1e-3) << c.name << ": it comes to rest";
            }
    EXPECT_GE(beyond, 8) << "walls that throw the hand without the controller";
}

} // namespace
} // namespace touchstone::test
