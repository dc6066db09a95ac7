// What is kept of the last seconds, and what is not.

#include "engine/core/error.h"
#include "haptics/recording/flight_recorder.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

namespace touchstone::test {
namespace {

class FlightRecorderTest : public testing::Test {
  protected:
    [[nodiscard]] FlightConfig config(double seconds = 0.5) const {
        return {.folder = scratch_ / "flight",
                .seconds = seconds,
                .afterwards = 0.1,
                .pause = 1.0,
                .origin = recordingOrigin("test", 1000.0)};
    }
    /// Ticks without a scene; a checkpoint every tenth of a second.
    void feed(FlightRecorder& recorder, uint64_t count, uint32_t flags = 0, uint32_t contacts = 0) {
        const HapticSettings settings;
        TouchCheckpoint checkpoint;
        takeCheckpoint(device_, checkpoint);
        for (uint64_t i = 0; i < count; ++i, ++tick_) {
            const bool due = tick_ % 100 == 0;
            checkpoint.tick = tick_;
            RecordedTick tick;
            tick.tick = tick_;
            tick.time = 1e-3 * static_cast<double>(tick_);
            tick.dt = 1e-3;
            tick.checkpoint = due;
            tick.flags = flags;
            tick.contacts = contacts;
            recorder.add({.tick = tick, .settings = settings, .checkpoint = due ? &checkpoint : nullptr});
            if (i % 33 == 0)
                recorder.flush();
        }
        recorder.flush();
    }
    /// Numbers of the ticks of a file, in order.
    static std::vector<uint64_t> ticksOf(const std::filesystem::path& file) {
        std::vector<uint64_t> numbers;
        for (const RecordedItem& item : itemsOf(file))
            if (const auto* block = std::get_if<RecordedTicks>(&item))
                for (const RecordedTick& tick : block->ticks)
                    numbers.push_back(tick.tick);
        return numbers;
    }
    [[nodiscard]] std::vector<std::filesystem::path> files() const {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "flight"))
            files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        return files;
    }

    ScratchFolder scratch_;
    DeviceState device_;
    uint64_t tick_ = 0;
};

const uint32_t kFault = 0u | TickFlag::ForceFault | TickFlag::SafetyLatched;

TEST_F(FlightRecorderTest, ACleanEndLeavesNothing) {
    {
        FlightRecorder recorder(config());
        feed(recorder, 3000);
        recorder.finish();
        EXPECT_TRUE(recorder.takeKept().empty());
        EXPECT_FALSE(files().empty()) << "while it lives the last seconds are there";
    }
    EXPECT_TRUE(files().empty());
}

TEST_F(FlightRecorderTest, KeepsTheLastSecondsBeforeAFaultAndATenthAfterIt) {
    FlightRecorder recorder(config());
    feed(recorder, 3050);
    feed(recorder, 1, kFault);
    feed(recorder, 400, 0u | TickFlag::SafetyLatched);
    const std::vector<KeptFlight> kept = recorder.takeKept();
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_TRUE(kept[0].file.filename().string().starts_with("force-fault-")) << kept[0].file;
    const std::vector<uint64_t> ticks = ticksOf(kept[0].file);
    ASSERT_FALSE(ticks.empty());
    for (size_t i = 1; i < ticks.size(); ++i)
        ASSERT_EQ(ticks[i], ticks[i - 1] + 1) << "both halves in order, without a gap";
    EXPECT_LE(ticks.front(), 3050u - 500u) << "half a second was asked for";
    EXPECT_GE(ticks.front(), 3050u - 1300u) << "and not for ever";
    EXPECT_GE(ticks.back(), 3050u + 100u);
    RecordingReader reader(kept[0].file);
    std::vector<RecordedNote> notes;
    while (const auto item = reader.next())
        if (const auto* note = std::get_if<RecordedNote>(&item->item))
            notes.push_back(*note);
    EXPECT_FALSE(reader.cutOff());
    EXPECT_TRUE(reader.damage().empty());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].tick, 3050u);
}

TEST_F(FlightRecorderTest, HoldsNoMoreThanTwiceTheSecondsAndACheckpoint) {
    FlightRecorder recorder(config()); // half a second, checkpoints a tenth apart
    for (int i = 0; i < 20; ++i) {
        feed(recorder, 1100);
        feed(recorder, 1, kFault);
        feed(recorder, 149);
        for (const KeptFlight& kept : recorder.takeKept())
            EXPECT_LE(ticksOf(kept.file).size(), 500u + 500u + 150u) << "rounding must not double it";
    }
}

TEST_F(FlightRecorderTest, AFaultAtTheEndIsKeptWithoutWaiting) {
    FlightRecorder recorder(config());
    feed(recorder, 250);
    feed(recorder, 1, kFault);
    EXPECT_TRUE(recorder.takeKept().empty());
    recorder.finish();
    const std::vector<KeptFlight> kept = recorder.takeKept();
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(ticksOf(kept[0].file).back(), 250u);
}

TEST_F(FlightRecorderTest, AStormOfFaultsMakesFewFilesAndTheOldestGo) {
    FlightConfig limited = config();
    limited.maxFiles = 3;
    FlightRecorder recorder(limited);
    size_t kept = 0;
    for (int i = 0; i < 60; ++i) { // a fault every 0.2 s for twelve seconds
        feed(recorder, 199);
        feed(recorder, 1, kFault);
        kept += recorder.takeKept().size();
    }
    EXPECT_GE(kept, 6u);
    EXPECT_LE(kept, 13u) << "once a second";
    size_t there = 0;
    for (const std::filesystem::path& file : files())
        there += file.filename().string().starts_with("force-fault-") ? 1 : 0;
    EXPECT_EQ(there, 3u);
}

TEST_F(FlightRecorderTest, KeepsWithinItsBytesButAlwaysTheNewest) {
    FlightConfig limited = config();
    limited.maxBytes = 1;
    FlightRecorder recorder(limited);
    for (int i = 0; i < 3; ++i) {
        feed(recorder, 1500);
        feed(recorder, 1, kFault);
        feed(recorder, 200);
        const std::vector<KeptFlight> now = recorder.takeKept();
        ASSERT_EQ(now.size(), 1u);
        EXPECT_GT(ticksOf(now[0].file).back(), tick_ - 200) << "the newest";
        size_t there = 0;
        for (const std::filesystem::path& file : files())
            there += file.filename().string().starts_with("force-fault-") ? 1 : 0;
        EXPECT_EQ(there, 1u);
    }
}

TEST_F(FlightRecorderTest, ASessionThatWasKilledIsKeptByTheNextAndALivingOneLeftAlone) {
    FlightRecorder alive(config());
    feed(alive, 100);
    const pid_t child = fork();
    if (child == 0) {
        FlightRecorder dies(config());
        feed(dies, 1777);
        raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    const std::vector<KeptFlight> kept = FlightRecorder::recover(config());
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_TRUE(kept[0].file.filename().string().starts_with("crash-")) << kept[0].file;
    const std::vector<uint64_t> ticks = ticksOf(kept[0].file);
    ASSERT_FALSE(ticks.empty());
    EXPECT_EQ(ticks.back(), 1876u) << "to the last flush";
    EXPECT_LE(ticks.front(), 1876u - 500u);
    for (size_t i = 1; i < ticks.size(); ++i)
        ASSERT_EQ(ticks[i], ticks[i - 1] + 1);
    EXPECT_EQ(kept[0].file.filename().string().size(), std::string("crash-yyyymmdd-hhmmss.tsrec").size());
    EXPECT_TRUE(FlightRecorder::recover(config()).empty()) << "once";
    feed(alive, 100);
    EXPECT_TRUE(std::filesystem::exists(alive.session().string() + "-a.tsrec"));
}

TEST_F(FlightRecorderTest, AFolderThatCannotBeIsSaid) {
    FlightConfig impossible = config();
    impossible.folder = "/dev/null/flight";
    EXPECT_THROW(FlightRecorder{impossible}, Error);
    EXPECT_TRUE(FlightRecorder::recover(impossible).empty());
}

TEST_F(FlightRecorderTest, WhatIsKeptOfAServoReplaysFromTheMiddle) {
    const TouchedScene doughnut = touchedScene("doughnut.glb");
    bool plugged = true;
    RecordedServo rig(
        [&](double time) {
            DeviceSample sample = at(overTheDoughnut(time));
            sample.valid = plugged;
            return sample;
        },
        {.rateHz = 1000.0, .ringCapacity = 1 << 14, .wantRealtime = false});
    rig.recorder.startFlightRecorder(config(1.0));
    rig.offer(doughnut);
    rig.steps(3500);
    plugged = false;
    rig.steps(300);
    const std::vector<KeptFlight> kept = rig.recorder.takeKept();
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_TRUE(kept[0].file.filename().string().starts_with("input-lost-")) << kept[0].file;
    const ReplayReport report = replayOf(kept[0].file, rig.scenes);
    expectEqualReplay(report);
    EXPECT_FALSE(report.cutOff);
    EXPECT_EQ(report.gaps, 0u);
    EXPECT_FALSE(report.notes.empty());
    EXPECT_GT(ticksOf(kept[0].file).front(), 0u) << "from the middle of the run";
    EXPECT_GT(rig.inContact(), 1000u);
}

TEST_F(FlightRecorderTest, NoDescriptorStaysOpen) {
    const auto open = [] {
        const std::filesystem::directory_iterator all("/proc/self/fd");
        return std::distance(begin(all), end(all));
    };
    const auto before = open();
    {
        FlightRecorder alive(config());
        feed(alive, 100);
        const auto recording = open();
        EXPECT_TRUE(FlightRecorder::recover(config()).empty()) << "it lives";
        EXPECT_EQ(open(), recording);
        FlightRecorder beside(config()); // of the same process: a session of its own
        EXPECT_NE(beside.session(), alive.session());
    }
    EXPECT_EQ(open(), before);
}

TEST_F(FlightRecorderTest, FaultsOfAnotherKindDoNotWaitForEachOther) {
    FlightRecorder recorder(config()); // a pause of a second after a fault of one kind
    feed(recorder, 1000);
    feed(recorder, 1, kFault);
    feed(recorder, 150);
    EXPECT_EQ(recorder.takeKept().size(), 1u);
    feed(recorder, 1, 0u | TickFlag::SafetyLatched);
    feed(recorder, 150);
    EXPECT_EQ(recorder.takeKept().size(), 1u) << "a latch, a sixth of a second after the fault";
    feed(recorder, 1, kFault);
    feed(recorder, 150);
    EXPECT_EQ(recorder.takeKept().size(), 0u) << "the same again within its second";
    feed(recorder, 1000);
    feed(recorder, 1, kFault);
    feed(recorder, 150);
    EXPECT_EQ(recorder.takeKept().size(), 1u);
}

TEST_F(FlightRecorderTest, WhereOneSegmentHasJustBegunTheOtherIsKept) {
    for (const char* spoilt : {"-a.tsrec", "-b.tsrec"}) {
        const pid_t child = fork();
        if (child == 0) {
            FlightRecorder dies(config());
            feed(dies, 1777);
            raise(SIGKILL);
        }
        int status = 0;
        waitpid(child, &status, 0);
        for (const std::filesystem::path& file : files())
            if (file.string().ends_with(spoilt) && file.filename().string().starts_with("live-"))
                std::filesystem::resize_file(file, 0);
        const std::vector<KeptFlight> kept = FlightRecorder::recover(config());
        ASSERT_EQ(kept.size(), 1u) << spoilt;
        EXPECT_GE(ticksOf(kept[0].file).size(), 200u) << spoilt;
    }
}

} // namespace
} // namespace touchstone::test
