// A picture that stalls while the mouse presses: the press stays what was asked for, no energy is added, and
// no device is to blame. Frames are 33 ticks apart; a stalled one tells the hand nothing.

#include "devices/mouse/mouse_device.h"
#include "devices/mouse/mouse_hand.h"
#include "haptics/query/surface_pick.h"
#include "haptics/recording/fault_watch.h"
#include "haptics/recording/recording_writer.h"
#include "tests/stability/handover/stepped_servo.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace touchstone::test::mouse_stall_test {
namespace {

constexpr double kTick = 1e-3;
constexpr int kFrame = 33;
constexpr double kHair = 1e-12; // rounding
constexpr double kOwn = 1.05;   // what the surface would give, of the press: the hand does not sink in

/// A line of sight.
struct Picker {
    glm::dvec3 eye, along;
};

/// The window's mouse without a window: what it points at, a button and a press.
class StalledWindow {
  public:
    StalledWindow(const std::string& file, const HapticSettings& settings, const Picker& picker)
        : scene_(touchedScene(file)), picker_(picker), servo_(mouse_), seen_(scene_.source, *scene_.haptic) {
        servo_.loop.setSettings(settings);
        (void)servo_.loop.offerScene(scene_.haptic, scene_.source);
        stiffness_ = settings.stiffness;
    }

    /// The goal that ViewControl gives.
    void frame(double press) {
        const double time = servo_.record.time;
        const ObjectMotions motions = seen_.advance(time);
        const auto hit = pickSurface(*scene_.haptic, motions, picker_.eye, picker_.along);
        if (!hit)
            return mouse_.release();
        MouseHand hand(hit->point);
        hand.pointAt({hit->point, hit->normal, stiffness_}, {.force = press});
        MouseGoal goal{.position = hand.goal(), .press = press, .stiffness = stiffness_};
        if (!motions.empty()) {
            goal.object = hit->object;
            goal.position =
                motions[static_cast<size_t>(hit->object)].workspaceFromObject.inversePoint(hand.goal());
        }
        mouse_.moveTo(goal);
        press_ = press;
    }
    void frames(int count, double press) {
        for (int i = 0; i < count; ++i) {
            frame(press);
            ticks(kFrame);
        }
    }
    /// Without a picture.
    void ticks(int count) {
        for (int i = 0; i < count; ++i)
            tick();
    }
    /// The whole process stands still.
    void skip(int count) {
        servo_.next += static_cast<uint64_t>(count);
        tick();
    }
    void tick() {
        const TickRecord before = servo_.record;
        const TickRecord& now = servo_.step();
        double& most = press_ > 0.0 ? maxForce : maxHovering;
        most = std::max(most, glm::length(now.output.force) / (press_ > 0.0 ? press_ : 1.0));
        if (press_ > 0.0)
            maxOwn = std::max(maxOwn, ownForce() / press_);
        const ObjectMotions motions = moved_.advance(now.time);
        glm::dvec3 way = now.output.hip - before.output.hip;
        if (const int object = before.output.object; object >= 0 && !motions.empty()) {
            const ObjectMotion& motion = motions[static_cast<size_t>(object)];
            way = now.output.hip -
                  motion.workspaceFromObject.point(motion.before.inversePoint(before.output.hip));
        }
        work_ += glm::dot(before.output.command.force(), way);
        maxEnergy = std::max(maxEnergy, work_ + stored() - storedBefore_);
        maxBalance = std::max(maxBalance, now.output.energyBalance);
        if (const std::optional<Fault> fault = watch_.add(recordedTick(now)))
            faults += fault->name + " ";
    }
    void switchForce(bool on) {
        ForceSwitch& force = servo_.loop.forceSwitch();
        if (on)
            EXPECT_TRUE(force.giveBack(force.state()));
        else
            force.takeAway(true);
    }
    [[nodiscard]] double force() const { return glm::length(servo_.record.output.force); }
    /// N, of the surface, also where the hand gives way.
    [[nodiscard]] double ownForce() const { return force() / servo_.record.output.borne; }
    [[nodiscard]] bool touching() const { return servo_.record.output.contacts > 0; }

    void countEnergy() {
        work_ = maxEnergy = 0.0;
        storedBefore_ = stored();
    }

    double maxForce = 0.0;    ///< while it presses, of what was asked for
    double maxOwn = 0.0;      ///< the same, of the surface's own force
    double maxHovering = 0.0; ///< N, while it does not
    /// J since countEnergy: given to the hand beyond what the objects' own motion did, and more in the
    /// springs than then.
    double maxEnergy = 0.0;
    double maxBalance = 0.0; ///< J
    std::string faults;

  private:
    [[nodiscard]] double stored() const { return 0.5 * ownForce() * servo_.record.output.penetration; }

    TouchedScene scene_;
    Picker picker_;
    MouseDevice mouse_;
    SteppedServo servo_;
    WorldState seen_, moved_{scene_.source, *scene_.haptic};
    FaultWatch watch_;
    double press_ = 0.0, stiffness_ = 600.0;
    double work_ = 0.0, storedBefore_ = 0.0;
};

const Picker kFromAbove{{0.01, 0.5, 0.02}, {0.0, -1.0, 0.0}};
Picker fromTheFront(double x, double y) {
    return {{x, y, 0.5}, {0.0, 0.0, -1.0}};
}

struct Place {
    const char* file;
    Picker picker;
};
const Place kPlaces[]{{"plane.glb", kFromAbove},
                      {"doughnut.glb", fromTheFront(0.0529, 0.0)},
                      {"box.glb", fromTheFront(0.01, 0.01)},
                      {"swatches.glb", fromTheFront(0.01, 0.02)},
                      {"moving.glb", kFromAbove}};

HapticSettings settingsWith(double stiffness) {
    HapticSettings settings;
    settings.stiffness = stiffness;
    return settings;
}

TEST(MouseStall, NeverPressesHarderThanAsked) {
    int touched = 0;
    for (const Place& place : kPlaces)
        for (const double stiffness : {600.0, 3500.0})
            for (const double press : {0.6, 3.0})
                for (const int stall : {20, 200, 2000}) {
                    StalledWindow window(place.file, settingsWith(stiffness), place.picker);
                    window.frames(6, 0.0);
                    window.frames(30, press);
                    if (!window.touching())
                        continue; // what moves has moved away
                    ++touched;
                    window.countEnergy();
                    window.ticks(stall);
                    const std::string what = std::string(place.file) + ", " + std::to_string(stiffness) +
                                             " N/m, " + std::to_string(press) + " N, " +
                                             std::to_string(stall) + " ms";
                    EXPECT_TRUE(window.touching()) << what;
                    const bool moving = std::string(place.file) == "moving.glb";
                    // Where the hand still slides after what moves, a tick gives k (v T)^2 / 2 by sampling.
                    EXPECT_LT(window.maxEnergy, moving ? 3e-6 : 1e-9) << what;
                    window.frames(10, press);
                    EXPECT_LE(window.maxForce, 1.0 + kHair) << what;
                    EXPECT_LE(window.maxOwn, kOwn) << what;
                    EXPECT_EQ(window.faults, "") << what;
                    if (!moving) {
                        EXPECT_NEAR(window.force(), press, 0.05 * press) << what;
                        EXPECT_LT(window.maxEnergy, 1e-6) << what << ": nor when the picture goes on";
                    }
                }
    EXPECT_EQ(touched, 5 * 2 * 2 * 3);
}

/// A mouse on its way through the air, and a floor of 3500 N/m that it does not point at.
struct HitFloor {
    HitFloor() : servo(mouse) {
        const TouchedScene floor = floorOf(0.0f, 3500.0f);
        (void)servo.loop.offerScene(floor.haptic, floor.source);
        go({.position = {0.0, 0.02, 0.0}, .press = 0.0}, 300);
    }
    void go(const MouseGoal& goal, int ticks) {
        mouse.moveTo(goal);
        for (int i = 0; i < ticks; ++i) {
            const TickRecord& now = servo.step();
            felt = std::max(felt, glm::length(now.output.force));
            given = std::max(given, glm::length(now.output.command.force()));
            touched += now.output.contacts > 0 ? 1 : 0;
        }
    }
    MouseDevice mouse;
    SteppedServo servo;
    double felt = 0.0, given = 0.0; // N
    int touched = 0;                // ticks
};

/// Where it came down fast it was given up to 1.75 N for a tick.
TEST(MouseStall, WhatDoesNotPressIsGivenNothing) {
    HitFloor strike;
    strike.go({.position = {0.0, -0.1, 0.0}, .press = 0.0}, 300);
    EXPECT_GT(strike.touched, 100);
    EXPECT_GT(strike.felt, 0.5) << "it strikes";
    EXPECT_EQ(strike.given, 0.0);
    EXPECT_LT(glm::length(strike.servo.record.output.force), 2.0 * MouseDevice::kHoverForce);
    strike.go({.position = {0.0, 0.003, 0.0}, .press = 0.0}, 300);
    EXPECT_EQ(strike.given, 0.0);
    // A press that is let go of fades with the hand's leaving; then there is none again.
    strike.go({.position = {0.0, -0.005, 0.0}, .press = 0.6, .stiffness = 3500.0}, 500);
    EXPECT_NEAR(strike.given, 0.6, 0.03);
    strike.go({.position = {0.0, 0.003, 0.0}, .press = 0.0}, 300);
    strike.given = 0.0;
    strike.go({.position = {0.0, -0.02, 0.0}, .press = 0.0}, 300);
    EXPECT_EQ(strike.given, 0.0);
}

TEST(MouseStall, WhatStrikesAStifferSurfaceThanItPointsAtPressesAsAsked) {
    HitFloor strike;
    strike.go({.position = {0.0, -0.1, 0.0}, .press = 0.6, .stiffness = 600.0, .stiffest = 3500.0}, 500);
    EXPECT_NEAR(glm::length(strike.servo.record.output.force), 0.6, 0.03);
    EXPECT_LE(strike.felt, 0.6 * (1.0 + kHair));
    EXPECT_LE(strike.given, 0.6 * (1.0 + kHair));
}

/// Two squares side by side in the plane y = 0: 300 N/m where x < 0, 3000 N/m where x > 0.
TouchedScene softAndStiff(float friction) {
    auto source = std::make_shared<Scene>();
    source->path = "soft and stiff";
    for (int side = 0; side < 2; ++side) {
        const float left = side == 0 ? -0.05f : 0.0f, right = left + 0.05f;
        Mesh mesh;
        mesh.positions = {{left, 0, -0.05f}, {left, 0, 0.05f}, {right, 0, 0.05f}, {right, 0, -0.05f}};
        mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
        mesh.indices = {0, 1, 2, 0, 2, 3};
        mesh.material = side;
        source->meshes.push_back(std::move(mesh));
        HapticMaterial& material = source->materials.emplace_back().haptic;
        material.stiffness.value = side == 0 ? 300.0f : 3000.0f;
        material.staticFriction.value = material.dynamicFriction.value = friction;
        source->nodes.emplace_back();
        source->instances.push_back({.node = side, .mesh = side});
    }
    TouchedScene scene;
    scene.haptic = compileHapticScene(*source, Similarity{});
    scene.source = std::move(source);
    scene.identity = identify(*scene.haptic, *scene.source, Fit::None);
    return scene;
}

/// A tick found it as deep in the stiffer surface as the soft one allowed: ten times the press for a tick.
TEST(MouseStall, SlidAcrossTheBorderToAStifferSurfaceItPressesAsAskedInEveryTick) {
    constexpr double kPress = 1.0;
    for (const float friction : {0.0f, 0.5f})
        for (const double speed : {0.02, 0.1, 0.4}) // m/s
            for (const int stalled : {0, 300}) {    // ticks without a picture, from before the border on
                MouseDevice mouse;
                SteppedServo servo(mouse);
                const TouchedScene scene = softAndStiff(friction);
                (void)servo.loop.offerScene(scene.haptic, scene.source);
                const std::string what = std::to_string(friction) + ", " + std::to_string(speed) + " m/s, " +
                                         std::to_string(stalled) + " ticks";
                double felt = 0.0, given = 0.0;
                int yielded = 0;
                const auto go = [&](double x, double press, int ticks) {
                    const double stiffness = x < 0.0 ? 300.0 : 3000.0;
                    MouseHand hand(glm::dvec3(0.0));
                    hand.pointAt({.point = {x, 0.0, 0.01}, .normal = {0, 1, 0}, .stiffness = stiffness},
                                 {.force = press});
                    mouse.moveTo({.position = hand.goal(),
                                  .press = press,
                                  .stiffness = stiffness,
                                  .stiffest = 3000.0,
                                  .friction = friction});
                    for (int i = 0; i < ticks; ++i) {
                        const HapticOutput& now = servo.step().output;
                        felt = std::max(felt, glm::length(now.force));
                        given = std::max(given, glm::length(now.command.force()));
                        yielded += now.borne < 1.0 / kOwn ? 1 : 0;
                        EXPECT_TRUE(press == 0.0 || now.contacts > 0 || i < 200) << what;
                    }
                };
                go(-0.02, 0.0, 200);
                go(-0.02, kPress, 500);
                EXPECT_NEAR(felt, kPress, 0.02) << what;
                EXPECT_NEAR(servo.record.output.penetration, kPress / 300.0, 2e-4) << what;
                for (double x = -0.02; x < 0.02; x += speed * 1e-3 * kFrame)
                    go(x, kPress, kFrame + (std::abs(x) < 1.5 * speed * 1e-3 * kFrame ? stalled : 0));
                go(0.02, kPress, 1000);
                EXPECT_GT(servo.record.output.hip.x, 0.01) << what;
                EXPECT_NEAR(glm::length(servo.record.output.force), kPress, 0.02) << what;
                EXPECT_NEAR(servo.record.output.penetration, kPress / 3000.0, 2e-5) << what << ": came up";
                for (double x = 0.02; x > -0.02; x -= speed * 1e-3 * kFrame)
                    go(x, kPress, kFrame);
                go(-0.02, kPress, 1000);
                EXPECT_NEAR(glm::length(servo.record.output.force), kPress, 0.02) << what;
                EXPECT_LE(felt, kPress * (1.0 + kHair)) << what;
                EXPECT_LE(given, kPress * (1.0 + kHair)) << what;
                EXPECT_GT(yielded, 0) << what << ": the surface offered more";
                EXPECT_LT(yielded, 3) << what << ": for a tick";
            }
}

TEST(MouseStall, NorWhenTheWholeProcessStoodStill) {
    for (const Place& place : kPlaces)
        for (const double stiffness : {600.0, 3500.0}) {
            StalledWindow window(place.file, settingsWith(stiffness), place.picker);
            window.frames(6, 0.0);
            window.frames(30, 0.6);
            if (!window.touching())
                continue;
            window.countEnergy();
            window.skip(2000);
            window.ticks(20);
            EXPECT_LE(window.maxForce, 1.0 + kHair) << place.file;
            EXPECT_LE(window.maxOwn, kOwn) << place.file;
            // What moves is elsewhere, two seconds on: the hand is there too, but for what sticks; and the
            // command fades in from nothing, while what moves goes on.
            EXPECT_LT(window.maxEnergy, std::string(place.file) == "moving.glb" ? 3e-4 : 1e-9) << place.file;
            EXPECT_EQ(window.faults, "");
        }
}

/// What moves takes along a hand that presses, and one that hovers.
TEST(MouseStall, AMovingModelIsPressedWithWhatWasAskedForAllTheTime) {
    int touching = 0;
    for (int start = 0; start < 10; ++start) {
        StalledWindow window("moving.glb", settingsWith(600.0), kFromAbove);
        window.ticks(300 * start);
        window.frames(6, 0.0);
        EXPECT_FALSE(window.touching());
        window.ticks(2000);
        EXPECT_FALSE(window.touching()) << "it hovers";
        window.frames(2, 0.0);
        window.frames(20, 0.6);
        touching += window.touching() ? 1 : 0;
        window.ticks(2000);
        EXPECT_LE(window.maxForce, 1.0 + kHair) << "from tick " << 300 * start;
        EXPECT_LE(window.maxOwn, kOwn) << "from tick " << 300 * start;
        EXPECT_LT(window.maxHovering, 0.15) << "what runs into it pushes it aside";
        EXPECT_EQ(window.faults, "");
    }
    EXPECT_GT(touching, 4);
}

/// The safety stage fades and takes the force away for many reasons. The hand does not sink in meanwhile, to
/// be pushed out again.
TEST(MouseStall, AForceThatIsOffLetsTheHandStayWhereItPresses) {
    StalledWindow window("plane.glb", settingsWith(3500.0), kFromAbove);
    window.frames(6, 0.0);
    window.frames(30, 0.6);
    EXPECT_NEAR(window.force(), 0.6, 0.01);
    for (int i = 0; i < 5; ++i) {
        window.switchForce(false);
        window.frames(20, 0.6);
        EXPECT_NEAR(window.force(), 0.6, 0.01);
        window.switchForce(true);
        window.frames(20, 0.6);
    }
    EXPECT_LE(window.maxForce, 1.0 + kHair);
    EXPECT_LE(window.maxOwn, kOwn);
    EXPECT_LT(window.maxBalance, 1e-6);
}

} // namespace
} // namespace touchstone::test::mouse_stall_test
