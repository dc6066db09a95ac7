// Several hands in one servo: each is what it would be alone, within its own limits, and is replayed.

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/recording/recording_writer.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

namespace touchstone::test {
namespace {

constexpr ServoConfig kUnhurried{.rateHz = 1000.0, .ringCapacity = 1 << 14, .wantRealtime = false};
const DeviceLimits kStrong{.maxForce = 6.0, .maxForceRate = 3000.0};
const DeviceLimits kWeak{.maxForce = 1.5, .maxForceRate = 400.0, .recommendedStiffness = 1500.0};

/// In and out of the first object of a scene, from a direction of its own.
RecordedServo::Hand tapping(const TouchedScene& scene, const glm::dvec3& from, const DeviceLimits& limits) {
    return [sphere = scene.haptic->restSpheres[0], from = glm::normalize(from), limits](double time) {
        const double depth = 1.0 + 0.6 * std::cos(12.0 * time);
        DeviceSample sample = at(glm::dvec3(sphere) + sphere.w * depth * from);
        sample.limits = limits;
        return sample;
    };
}

/// The records of `hand`.
std::vector<TickRecord> recordsOf(const RecordedServo& rig, uint32_t hand) {
    std::vector<TickRecord> own;
    for (const std::vector<TickRecord>* records : {&rig.records, &rig.others})
        for (const TickRecord& record : *records)
            if (record.hand == hand)
                own.push_back(record);
    return own;
}

/// Every stage of every tick is equal to the last bit.
void expectSameBits(const std::vector<TickRecord>& records, const std::vector<TickRecord>& expected) {
    ASSERT_EQ(records.size(), expected.size());
    for (size_t i = 0; i < records.size(); ++i)
        ASSERT_EQ(stageHashes(records[i].trace, records[i].output),
                  stageHashes(expected[i].trace, expected[i].output))
            << "hand " << records[i].hand << ", tick " << i;
}

class HandsTest : public testing::Test {
  protected:
    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
};

TEST_F(HandsTest, OfTwoOnAMovingObjectEachIsWhatItIsAlone) {
    const TouchedScene scene = touchedScene("moving.glb");
    const std::vector<RecordedServo::Hand> hands{tapping(scene, {0.3, 1.0, 0.2}, kStrong),
                                                 tapping(scene, {-0.4, 0.8, 0.5}, kWeak)};
    RecordedServo both(hands, kUnhurried);
    both.recorder.start(file_, "test");
    both.offer(scene);
    both.steps(4000);
    both.finish();
    for (uint32_t hand = 0; hand < 2; ++hand) {
        RecordedServo alone(hands[hand], kUnhurried);
        alone.offer(scene);
        alone.steps(4000);
        const std::vector<TickRecord> records = recordsOf(both, hand);
        expectSameBits(records, alone.records);
        const auto contacts = std::ranges::count_if(
            records, [](const TickRecord& record) { return record.output.contacts > 0; });
        EXPECT_GT(contacts, 200) << "hand " << hand;
    }
    both.expectWithinLimits();
    double strongest[2] = {0.0, 0.0};
    for (uint32_t hand = 0; hand < 2; ++hand)
        for (const TickRecord& record : recordsOf(both, hand))
            strongest[hand] = std::max(strongest[hand], glm::length(record.output.command.force()));
    EXPECT_GT(strongest[0], kWeak.maxForce) << "one has more than the other may";
    EXPECT_NEAR(strongest[1], kWeak.maxForce, 1e-9);
    const ReplayReport report = replayOf(file_, both.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.hands, 2u);
    EXPECT_EQ(report.ticks, 4000u);
}

TEST_F(HandsTest, ARunningServoIsReplayedAcrossScenesSettingsAndALateStart) {
    const TouchedScene doughnut = touchedScene("doughnut.glb"), moving = touchedScene("moving.glb");
    RecordedServo rig({[](double time) { return at(overTheDoughnut(time)); },
                       tapping(doughnut, {1.0, 0.2, 0.4}, kWeak), tapping(moving, {0.0, 1.0, 0.3}, kStrong)},
                      {.rateHz = 2000.0, .ringCapacity = 1 << 14, .wantRealtime = false});
    rig.offer(doughnut);
    rig.ticks(1500);
    rig.recorder.start(file_, "test"); // in the middle
    rig.ticks(3000);
    HapticSettings sticky;
    sticky.staticFriction = 1.2;
    rig.servo.setSettings(sticky);
    rig.ticks(1000);
    rig.offer(moving);
    rig.ticks(3000);
    rig.finish();
    rig.expectWithinLimits();
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.hands, 3u);
}

TEST_F(HandsTest, AHandThatVanishesChangesNothingForTheOther) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    const auto first = [](double time) { return at(overTheDoughnut(time)); };
    const auto vanishing = [](double time) {
        DeviceSample sample = at(overTheDoughnut(time));
        sample.limits = kWeak;
        sample.valid = time < 0.47 || time > 1.4;
        return sample;
    };
    RecordedServo both({first, vanishing}, kUnhurried), alone(first, kUnhurried);
    for (RecordedServo* rig : {&both, &alone}) {
        rig->offer(scene);
        rig->steps(2000);
    }
    expectSameBits(both.records, alone.records);
    const std::vector<TickRecord> lost = recordsOf(both, 1);
    EXPECT_GT(glm::length(lost[469].output.command.force()), 0.1);
    double other = 0.0;
    for (size_t i = 525; i < 1400; ++i) {
        ASSERT_EQ(glm::length(lost[i].output.command.force()), 0.0) << "faded out";
        other = std::max(other, glm::length(both.records[i].output.command.force()));
    }
    EXPECT_GT(other, 0.3) << "the other one's goes on";
}

TEST_F(HandsTest, AChangedTickOfTheSecondHandIsNamed) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    const auto hand = [](double time) { return at(overTheDoughnut(time)); };
    RecordedServo rig({hand, hand}, kUnhurried);
    rig.recorder.start(file_, "test");
    rig.offer(scene);
    rig.steps(1500);
    rig.finish();
    std::vector<RecordedItem> items = itemsOf(file_);
    for (RecordedItem& item : items)
        if (auto* block = std::get_if<RecordedHandTicks>(&item))
            for (RecordedTick& tick : block->ticks.ticks)
                if (tick.tick == 700)
                    tick.sample.position.x += 1e-6;
    writeItems(file_, items);
    const ReplayReport report = replayOf(file_, rig.scenes);
    ASSERT_TRUE(report.first.has_value());
    EXPECT_EQ(report.first->tick, 700u);
    EXPECT_EQ(report.first->hand, 1u);
    EXPECT_EQ(report.first->stage, "sample");
    EXPECT_LT(report.differing, 400u) << "the next checkpoint has the recorded state";

    // Without its states, or without its ticks, no tick can be replayed.
    std::vector<RecordedItem> stateless = items;
    std::erase_if(stateless,
                  [](const RecordedItem& item) { return std::holds_alternative<RecordedHandState>(item); });
    writeItems(file_, stateless);
    EXPECT_THROW((void)replayOf(file_, rig.scenes), Error);
    std::erase_if(items,
                  [](const RecordedItem& item) { return std::holds_alternative<RecordedHandTicks>(item); });
    writeItems(file_, items);
    EXPECT_THROW((void)replayOf(file_, rig.scenes), Error);
}

TEST_F(HandsTest, PosesThatDifferAreNamed) {
    const TouchedScene scene = touchedScene("moving.glb");
    RecordedServo rig(tapping(scene, {0.3, 1.0, 0.2}, kStrong), kUnhurried);
    rig.recorder.start(file_, "test");
    rig.offer(scene);
    rig.steps(300);
    rig.finish();
    std::vector<RecordedItem> items = itemsOf(file_);
    for (RecordedItem& item : items)
        if (auto* block = std::get_if<RecordedTicks>(&item))
            for (RecordedTick& tick : block->ticks) {
                EXPECT_NE(tick.poses.value_or(0), 0u);
                if (tick.tick == 123)
                    *tick.poses ^= 1;
            }
    writeItems(file_, items);
    const ReplayReport report = replayOf(file_, rig.scenes);
    ASSERT_TRUE(report.first.has_value());
    EXPECT_EQ(report.first->tick, 123u);
    EXPECT_EQ(report.first->stage, "poses");
    EXPECT_EQ(report.differing, 1u);
}

TEST_F(HandsTest, TheFlightRecorderKeepsAllHandsAfterTheFaultOfOne) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    const auto hand = [](double time) { return at(overTheDoughnut(time)); };
    const auto lost = [](double time) {
        DeviceSample sample = at(overTheDoughnut(time));
        sample.valid = time < 1.5;
        return sample;
    };
    RecordedServo rig({hand, lost}, kUnhurried);
    rig.recorder.startFlightRecorder({.folder = scratch_ / "flight",
                                      .seconds = 0.5,
                                      .afterwards = 0.2,
                                      .origin = recordingOrigin("flight recorder", 1000.0)});
    rig.offer(scene);
    for (int i = 0; i < 60; ++i)
        rig.steps(50);
    rig.finish();
    const std::vector<KeptFlight> kept = rig.recorder.takeKept();
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_NE(kept[0].why.find("hand 2"), std::string::npos) << kept[0].why;
    const ReplayReport report = replayOf(kept[0].file, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.hands, 2u);
}

/// A reader that falls behind loses the ticks of all hands, never of one.
TEST_F(HandsTest, DroppedTicksAreDroppedForAllHands) {
    const auto hand = [](double time) { return at(overTheDoughnut(time)); };
    RecordedServo rig({hand, hand, hand}, {.rateHz = 1000.0, .ringCapacity = 64, .wantRealtime = false});
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.steps(40);
    for (int i = 0; i < 700; ++i)
        (void)rig.servo.step(rig.servo.counters().ticks);
    rig.drain();
    rig.steps(10);
    for (int i = 0; i < 40; ++i)
        rig.steps(50);
    rig.finish();
    EXPECT_GT(rig.servo.counters().droppedRecords, 500u);
    ASSERT_EQ(rig.others.size(), 2 * rig.records.size());
    for (size_t i = 0; i < rig.records.size(); ++i)
        for (size_t other = 0; other < 2; ++other)
            ASSERT_EQ(rig.others[2 * i + other].tick, rig.records[i].tick);
    const ReplayReport report = replayOf(file_, rig.scenes);
    EXPECT_EQ(report.differing, 0u);
    EXPECT_EQ(report.lost, rig.servo.counters().droppedRecords);
    EXPECT_GT(report.replayed, 1000u);
}

/// Each port is sent its own hand's command: in contact, without a scene, and zero at the end.
TEST_F(HandsTest, EachDeviceIsSentItsOwnCommand) {
    struct Port {
        glm::dvec3 place{0.0};
        DeviceLimits limits;
        glm::dvec3 sent{0.0};
        glm::dvec3 felt{0.0}; // of the preceding tick
    };
    std::vector<Port> ports{{.place = {0.0, 0.01, 0.0}, .limits = kStrong},
                            {.place = {0.02, 0.01, 0.0}, .limits = kWeak}};
    std::vector<DevicePort> connected;
    for (Port& port : ports)
        connected.push_back({.context = &port,
                             .sample =
                                 [](void* context, double) noexcept {
                                     DeviceSample sample = at(static_cast<Port*>(context)->place);
                                     sample.limits = static_cast<Port*>(context)->limits;
                                     return sample;
                                 },
                             .apply =
                                 [](void* context, const DeviceCommand& command) noexcept {
                                     static_cast<Port*>(context)->sent = command.force();
                                 },
                             .feel =
                                 [](void* context, const TouchFeedback& felt) noexcept {
                                     static_cast<Port*>(context)->felt = felt.force;
                                 }});
    ServoLoop loop(connected, kUnhurried);
    enterFloatMode();
    const TouchedScene floor = floorScene(0.0f);
    loop.offerScene(floor.haptic, floor.source);
    uint64_t tick = 0;
    const auto run = [&](int ticks, double down) {
        for (int i = 0; i < ticks; ++i) {
            ports[0].place.y -= down;
            ports[1].place.y -= 0.5 * down;
            (void)loop.step(tick++);
            TickRecord record;
            while (loop.popRecord(record))
                ASSERT_EQ(ports[record.hand].sent, record.output.command.force()) << tick;
        }
    };
    run(200, 0.0);
    run(300, 1e-4); // to 20 and 5 mm beneath the floor
    const double strong = ports[0].sent.y, weak = ports[1].sent.y;
    EXPECT_NEAR(strong, kStrong.maxForce, 1e-9);
    EXPECT_NEAR(weak, kWeak.maxForce, 1e-9);
    EXPECT_NEAR(ports[0].felt.y, 600.0 * 0.0199, 1e-3) << "of its own";
    EXPECT_NEAR(ports[1].felt.y, 1500.0 * 0.00495, 1e-3) << "of its own, at its device's stiffness";
    loop.offerScene(nullptr);
    for (int i = 1; i <= 3; ++i) { // each at its own slew
        (void)loop.step(tick++);
        EXPECT_NEAR(ports[0].sent.y, std::max(0.0, strong - 3.0 * i), 1e-9);
        EXPECT_NEAR(ports[1].sent.y, weak - 0.4 * i, 1e-9);
    }
    loop.start();
    loop.stop();
    for (const Port& port : ports)
        EXPECT_EQ(port.sent, glm::dvec3(0.0));
}

/// Format 1: the limits are the scene's.
TEST_F(HandsTest, ARecordingOfFormat1KeepsTheLimitsOfItsScene) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    RecordedServo rig(
        [](double time) {
            DeviceSample sample = at(overTheDoughnut(time));
            sample.limits = kWeak;
            return sample;
        },
        kUnhurried);
    rig.recorder.start(file_, "test");
    rig.offer(scene);
    rig.steps(1200);
    rig.finish();
    std::vector<RecordedItem> items = itemsOf(file_);
    for (RecordedItem& item : items) {
        if (auto* named = std::get_if<RecordedScene>(&item))
            named->identity.limits = kWeak;
        if (auto* block = std::get_if<RecordedTicks>(&item))
            for (RecordedTick& tick : block->ticks)
                tick.sample.limits = DeviceLimits{};
    }
    writeItems(file_, items);
    expectEqualReplay(replayOf(file_, rig.scenes));
    for (RecordedItem& item : items)
        if (auto* named = std::get_if<RecordedScene>(&item))
            named->identity.limits.reset();
    writeItems(file_, items);
    EXPECT_GT(replayOf(file_, rig.scenes).differing, 100u) << "they are needed";
}

/// Where the state of one hand was lost the replay goes on with what it knows.
TEST_F(HandsTest, ALostStateOfOneHandIsNoGap) {
    const auto hand = [](double time) { return at(overTheDoughnut(time)); };
    RecordedServo rig({hand, hand}, kUnhurried);
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.steps(2500);
    rig.finish();
    std::vector<RecordedItem> items = itemsOf(file_);
    int states = 0;
    std::erase_if(items, [&](const RecordedItem& item) {
        return std::holds_alternative<RecordedHandState>(item) && ++states == 2;
    });
    ASSERT_GE(states, 3);
    writeItems(file_, items);
    expectEqualReplay(replayOf(file_, rig.scenes));
}

TEST_F(HandsTest, AServoDrivesOneToFourHands) {
    const DevicePort port{.context = nullptr,
                          .sample = [](void*, double) noexcept { return DeviceSample{}; },
                          .apply = [](void*, const DeviceCommand&) noexcept {}};
    EXPECT_THROW(ServoLoop(std::vector<DevicePort>{}), Error);
    EXPECT_THROW(ServoLoop(std::vector<DevicePort>(kMaxHands + 1, port)), Error);
    EXPECT_EQ(ServoLoop(std::vector<DevicePort>(kMaxHands, port)).hands(), kMaxHands);
}

/// The hand is named only where there are several and it is a hand that differs.
TEST(WhichHand, IsNamedWhereThereAreSeveral) {
    ReplayReport report;
    report.hands = 2;
    EXPECT_EQ(whichHand(report), "") << "nothing differs";
    report.first.emplace();
    report.first->hand = 1;
    report.first->stage = "force";
    EXPECT_EQ(whichHand(report), "of hand 2, ");
    report.first->stage = "poses";
    EXPECT_EQ(whichHand(report), "") << "the poses are of all hands";
    report.first->stage = "force";
    report.hands = 1;
    EXPECT_EQ(whichHand(report), "");
}

} // namespace
} // namespace touchstone::test
