// Faults that happen to a servo: stalls, a device that is gone, scenes and settings that change under a hand
// in contact. In every tick the command is within its limits; all of it is recorded and replays to the last
// bit. No time is asserted.

#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>

namespace touchstone::test {
namespace {

constexpr ServoConfig kUsual{.rateHz = 1000.0, .ringCapacity = 1 << 14, .wantRealtime = false};

void stall(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

class ServoFaults : public testing::Test {
  protected:
    void begin(RecordedServo& rig) {
        rig.recorder.start(file_, "test");
        rig.offer(doughnut_);
    }
    /// Within its limits, felt at all, recorded without a gap, replayed to the last bit.
    void expectSound(RecordedServo& rig) {
        rig.finish();
        rig.expectWithinLimits();
        EXPECT_GT(rig.inContact(), 100u);
        EXPECT_TRUE(rig.recorder.takeProblem().empty());
        const ReplayReport report = replayOf(file_, rig.scenes);
        expectEqualReplay(report);
        EXPECT_EQ(report.ticks, rig.servo.counters().ticks) << "nothing recorded is lost";
        EXPECT_FALSE(report.cutOff);
    }
    static double forceOf(const TickRecord& record) { return glm::length(record.output.command.force()); }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
    TouchedScene doughnut_ = touchedScene("doughnut.glb");
};

TEST_F(ServoFaults, StallsOfTwentyMilliseconds) {
    int tick = 0, stalls = 0;
    RecordedServo rig(
        [&](double time) {
            if (++tick % 40 == 0) {
                stall(20);
                ++stalls;
            }
            return at(overTheDoughnut(time));
        },
        kUsual);
    begin(rig);
    rig.ticks(1500);
    expectSound(rig);
    EXPECT_GE(rig.servo.counters().skipped, static_cast<uint64_t>(19 * stalls))
        << "never made up for in a bunch";
    // One late tick is no broken loop; on a machine that is busy enough there may be one.
    uint32_t inARow = 0, most = 0;
    for (const TickRecord& record : rig.records) {
        inARow = record.late ? inARow + 1 : 0;
        most = std::max(most, inARow);
    }
    EXPECT_EQ(rig.countOf(TickFlag::SafetyLatched) > 0, most >= kLateTicksToLatch);
}

TEST_F(ServoFaults, LateTicksInARowFadeTheForceOutAreKeptAndForgivenByTheSwitch) {
    std::atomic<bool> slow{false};
    RecordedServo rig(
        [&](double time) {
            if (slow.load())
                stall(3);
            return at(overTheDoughnut(time));
        },
        kUsual);
    FlightConfig flight;
    flight.folder = scratch_ / "flight";
    flight.seconds = 1.0;
    flight.afterwards = 0.01;
    flight.origin = recordingOrigin("test", 1000.0);
    rig.recorder.startFlightRecorder(flight);
    begin(rig);
    rig.ticks(1500);
    slow = true;
    rig.ticks(60);
    slow = false;
    rig.ticks(300);
    EXPECT_TRUE(has(rig.records.back().output.flags, TickFlag::SafetyLatched));
    EXPECT_EQ(forceOf(rig.records.back()), 0.0);
    const std::vector<KeptFlight> kept = rig.recorder.takeKept();
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_TRUE(kept[0].file.filename().string().starts_with("safety-latched-")) << kept[0].file;
    expectEqualReplay(replayOf(kept[0].file, rig.scenes));
    HapticSettings off;
    off.forceEnabled = false;
    double most = 0.0;
    for (int tries = 0; tries < 10 && most <= 0.1; ++tries) { // a busy machine may have it latch again
        rig.servo.setSettings(off);
        rig.ticks(20);
        rig.servo.setSettings({});
        const size_t before = rig.records.size();
        rig.ticks(600);
        for (size_t i = before; i < rig.records.size(); ++i)
            most = std::max(most, forceOf(rig.records[i]));
    }
    EXPECT_GT(most, 0.1) << "it pushes again";
    expectSound(rig);
}

TEST_F(ServoFaults, ADeviceUnpluggedInContactAndPluggedInDeepInside) {
    int fault = 0;
    RecordedServo rig(
        [&](double time) {
            DeviceSample sample = at(overTheDoughnut(time));
            switch (fault) {
            case 1:
                sample.valid = false;
                break;
            case 2:
                sample.age = 1.0;
                break; // frozen
            case 3:
                sample.position.y = std::nan("");
                break;
            case 4:
                sample.position = glm::dvec3(INFINITY);
                break;
            case 5:
                sample.position.z -= 0.015;
                break; // back, in the middle of the tube
            case 6:
                sample.position.z += 0.01;
                break; // out of it
            default:
                break;
            }
            return sample;
        },
        kUsual);
    begin(rig);
    for (const int kind : {1, 2, 3, 4, 1}) {
        fault = 0;
        rig.steps(500);
        const auto pushed = std::count_if(rig.records.end() - 400, rig.records.end(),
                                          [](const TickRecord& record) { return forceOf(record) > 0.0; });
        EXPECT_GT(pushed, 50) << "before fault " << kind;
        fault = kind;
        rig.steps(300);
        EXPECT_EQ(forceOf(rig.records.back()), 0.0) << "faded out, fault " << kind;
        fault = 5;
        rig.steps(200);
        EXPECT_EQ(forceOf(rig.records.back()), 0.0) << "inside, fault " << kind;
        fault = 6;
        rig.steps(50);
    }
    expectSound(rig);
    EXPECT_GT(rig.countOf(TickFlag::InputInvalid), 1000u);
}

TEST_F(ServoFaults, ScenesSwappedInContact) {
    bool lifted = false; // what comes where the hand is, is felt when the hand has left it
    RecordedServo rig(
        [&](double time) { return at(overTheDoughnut(time) + glm::dvec3(0.0, 0.0, lifted ? 0.01 : 0.0)); },
        kUsual);
    begin(rig);
    rig.steps(400);
    const TouchedScene moving = touchedScene("moving.glb");
    for (int i = 0; i < 8; ++i) {
        rig.offer(floorOf(i % 2 == 0 ? 0.1f : -0.02f, 3000.0f));
        rig.steps(120);
        rig.offer(i % 3 == 0 ? moving : doughnut_);
        const auto touched = [&rig] {
            return std::ranges::count_if(rig.records, [&rig](const TickRecord& record) {
                return record.scene == rig.scenes.size() && record.output.contacts > 0;
            });
        };
        rig.steps(60);
        EXPECT_EQ(touched(), 0) << "not left yet";
        lifted = true;
        rig.steps(60);
        lifted = false;
        rig.steps(250);
        if (i % 3 != 0) {
            EXPECT_GT(touched(), 30);
        }
    }
    expectSound(rig);
    size_t swaps = 0;
    for (size_t i = 1; i < rig.records.size(); ++i)
        swaps += rig.records[i].scene != rig.records[i - 1].scene ? 1 : 0;
    EXPECT_EQ(swaps, 16u);
}

TEST_F(ServoFaults, SettingsChangedInContactAsFastAsTheyCan) {
    RecordedServo rig([&](double time) { return at(overTheDoughnut(time)); });
    begin(rig);
    std::mt19937 random(1);
    rig.ticks(6000, [&] {
        for (int i = 0; i < 200; ++i) {
            HapticSettings settings;
            settings.stiffness = static_cast<double>(random() % 100000);
            settings.damping = static_cast<double>(random() % 1000);
            settings.proxyRadius = 1e-3 * static_cast<double>(random() % 3);
            settings.staticFriction = static_cast<double>(random() % 100);
            settings.texture = static_cast<TextureMode>(random() % 4);
            settings.friction = static_cast<FrictionMode>(random() % 4);
            settings.forceShading = static_cast<ShadingMode>(random() % 5);
            settings.passivity = static_cast<PassivityMode>(random() % 3);
            settings.forceEnabled = random() % 8 != 0;
            rig.servo.setSettings(settings);
        }
    });
    expectSound(rig);
}

/// The same with a change between any two ticks, which a servo cannot be made to show.
TEST_F(ServoFaults, SettingsChangedInContactInEveryTick) {
    std::mt19937 random(4);
    DeviceState device;
    WorldState world;
    HapticOutput output;
    glm::dvec3 last(0.0);
    size_t contacts = 0;
    const DeviceLimits limits;
    doughnut_.haptic->buildNeighbourhoods();
    for (int tick = 0; tick < 30000; ++tick) {
        HapticSettings settings;
        settings.contact = static_cast<ContactMethod>(random() % 2);
        settings.stiffness = std::pow(10.0, static_cast<double>(random() % 6));
        settings.damping = static_cast<double>(random() % 1000) - 1.0;
        settings.proxyRadius = random() % 2 == 0 ? 0.0 : 1e-4 * static_cast<double>(random() % 500);
        settings.staticFriction = static_cast<double>(random() % 100);
        settings.texture = static_cast<TextureMode>(random() % 4);
        settings.friction = static_cast<FrictionMode>(random() % 4);
        settings.forceShading = static_cast<ShadingMode>(random() % 5);
        settings.passivity = static_cast<PassivityMode>(random() % 3);
        settings.iterationBudget = 1 + static_cast<int>(random() % 100);
        settings.forceEnabled = random() % 50 != 0;
        const DeviceSample sample = at(overTheDoughnut(1e-3 * tick));
        TickInput input;
        input.hands = {&sample, 1};
        NoStopwatch none;
        hapticStep(*doughnut_.haptic, settings, input, world, {&device, 1}, {&output, 1}, none);
        const glm::dvec3 force = output.command.force();
        ASSERT_TRUE(glm::length(force) <= limits.maxForce) << tick;
        ASSERT_LE(glm::length(force - last), limits.maxForceRate * input.dt + 1e-9) << tick;
        last = force;
        contacts += output.contacts > 0 ? 1 : 0;
    }
    EXPECT_GT(contacts, 1000u);
}

TEST_F(ServoFaults, ARecordingThatFailsIsSaidOnceAndTheServoGoesOn) {
    RecordedServo rig([&](double time) { return at(overTheDoughnut(time)); }, kUsual);
    begin(rig);
    rig.ticks(300);
    // The file's place becomes one where nothing can be written: what the recorder has open goes on, so the
    // failure must come from the next start.
    EXPECT_THROW(rig.recorder.start("/dev/full", "test"), std::exception);
    EXPECT_FALSE(rig.recorder.recording());
    rig.ticks(300);
    rig.finish();
    rig.expectWithinLimits();
    EXPECT_EQ(rig.records.size(), rig.servo.counters().ticks);
}

} // namespace
} // namespace touchstone::test
