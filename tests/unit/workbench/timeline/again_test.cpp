// What is made of a recording: ticks touched again around the cursor, the verdict, and the recorded hand in
// the servo of now.

#include "devices/device/mapped_device.h"
#include "engine/core/error.h"
#include "session/device_port.h"
#include "tests/unit/workbench/timeline/recordings.h"
#include "workbench/timeline/replay_cache.h"
#include "workbench/timeline/touch_again.h"
#include "workbench/timeline/verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <span>
#include <thread>

namespace touchstone::test::again_test {
namespace {

class StillHand final : public Device {
  public:
    std::string name() const override { return "still"; }
    DeviceLimits limits() const override { return {}; }
    DeviceSample sample(double) noexcept override { return at(place); }
    void apply(const DeviceCommand& command) noexcept override {
        most = std::max(most.load(), glm::length(command.force()));
    }

    void feel(const TouchFeedback& felt) noexcept override { animation = felt.animation; }

    glm::dvec3 place{0.0, 0.0, 0.2};
    std::atomic<double> most{0.0}; ///< N, that it was sent
    double animation = 0.0;        ///< s
};

void pause() {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

class AgainTest : public testing::Test {
  protected:
    /// Touches the doughnut, and gives what the servo lived through.
    std::vector<TickRecord> record() {
        RecordedServo rig([](double time) { return at(overTheDoughnut(time)); });
        rig.recorder.start(file_, "test");
        rig.offer(touchedScene("doughnut.glb"));
        rig.steps(9000);
        rig.finish();
        return rig.records;
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
};

TEST_F(AgainTest, TheLensShowsAllThatTheServoKnew) {
    const std::vector<TickRecord> lived = record();
    const auto timeline = timelineOf(file_);
    ASSERT_EQ(timeline->size(), lived.size());
    ReplayCache replayCache(timeline, std::make_shared<RecordedSceneShelf>(file_));
    std::vector<size_t> touching;
    for (size_t index = 0; index < lived.size(); ++index)
        if (lived[index].output.contacts > 0)
            touching.push_back(index);
    ASSERT_GT(touching.size(), 1000u);
    for (const size_t index :
         {size_t{0}, touching.front(), size_t{3000}, size_t{4001}, size_t{8500}, size_t{100},
          touching[touching.size() / 2], lived.size() - 1, touching.back()}) {
        while (!replayCache.complete(index) && replayCache.problem().empty()) {
            replayCache.look(index);
            pause();
        }
        ASSERT_EQ(replayCache.problem(), "");
        TickRecord shown;
        ASSERT_TRUE(replayCache.show(index, shown));
        const TickRecord& was = lived[index];
        EXPECT_EQ(shown.tick, was.tick);
        EXPECT_EQ(shown.time, was.time);
        EXPECT_EQ(shown.output.hip, was.output.hip) << index;
        EXPECT_EQ(shown.output.proxy, was.output.proxy) << index;
        EXPECT_EQ(shown.output.force, was.output.force) << index;
        EXPECT_EQ(shown.output.normal, was.output.normal) << index;
        EXPECT_EQ(shown.output.planeCount, was.output.planeCount) << index;
        EXPECT_EQ(shown.output.stictionPoint, was.output.stictionPoint) << index;
        EXPECT_EQ(shown.output.penetration, was.output.penetration) << index;
        EXPECT_EQ(shown.output.triangle, was.output.triangle) << index;
    }
}

TEST_F(AgainTest, WithoutItsModelTheLensShowsWhatWasRecorded) {
    const std::vector<TickRecord> lived = record();
    std::vector<RecordedItem> items = itemsOf(file_);
    for (RecordedItem& item : items)
        if (auto* scene = std::get_if<RecordedScene>(&item))
            scene->identity.path = scene->identity.absolutePath = "/nowhere/gone.glb";
    writeItems(file_, items);
    ReplayCache replayCache(timelineOf(file_), std::make_shared<RecordedSceneShelf>(file_));
    TickRecord shown;
    while (replayCache.problem().empty() || !replayCache.show(5000, shown)) {
        replayCache.look(5000);
        pause();
    }
    EXPECT_NE(replayCache.problem().find("gone.glb"), std::string::npos) << replayCache.problem();
    EXPECT_FALSE(replayCache.complete(5000));
    EXPECT_EQ(shown.output.proxy, lived[5000].output.proxy);
    EXPECT_EQ(shown.output.force, lived[5000].output.force);
    EXPECT_EQ(shown.output.planeCount, 0u);
}

TEST_F(AgainTest, OneDamagedSegmentLeavesTheOthersToBeSeen) {
    const std::vector<TickRecord> lived = record();
    const auto timeline = timelineOf(file_);
    ASSERT_GE(timeline->segments().size(), 2u);
    std::filesystem::resize_file(file_, timeline->segments()[1].offset + 100);
    const size_t damaged = timeline->segments()[1].first, sound = timeline->segments()[0].first;
    ReplayCache replayCache(timeline, std::make_shared<RecordedSceneShelf>(file_));
    TickRecord shown;
    int problems = 0;
    const auto look = [&](size_t index) {
        try {
            replayCache.look(index);
        } catch (const Error&) {
            ++problems;
        }
        pause();
    };
    for (int i = 0; i < 5000 && problems == 0; ++i)
        look(damaged);
    ASSERT_EQ(problems, 1);
    for (int i = 0; i < 5000 && !replayCache.complete(sound); ++i)
        look(sound);
    EXPECT_EQ(replayCache.problem(), "");
    ASSERT_TRUE(replayCache.show(sound, shown));
    EXPECT_EQ(shown.output.proxy, lived[sound].output.proxy);
    for (int i = 0; i < 20; ++i)
        look(damaged);
    EXPECT_FALSE(replayCache.show(damaged, shown));
    EXPECT_LT(problems, static_cast<int>(timeline->segments().size())) << "each is tried once";
}

TEST_F(AgainTest, VerifyingNamesTheTickThatDiffersAndItsStage) {
    (void)record();
    JobProgress progress;
    RecordedSceneShelf shelf(file_);
    const Verdict good = verify(*timelineOf(file_), shelf, progress);
    EXPECT_TRUE(good.equal());
    EXPECT_EQ(good.text(),
              "equal to the last bit in " + std::to_string(timelineOf(file_)->size()) + " ticks");

    std::vector<RecordedItem> items = itemsOf(file_);
    uint64_t changed = 0, before = 0;
    for (RecordedItem& item : items)
        if (auto* block = std::get_if<RecordedTicks>(&item); block != nullptr)
            for (RecordedTick& tick : block->ticks)
                if (before++ == 10) {
                    tick.hashes[6] ^= 1; // of the force
                    changed = tick.tick;
                }
    ASSERT_GT(changed, 0u);
    writeItems(file_, items);
    const Verdict bad = verify(*timelineOf(file_), shelf, progress);
    EXPECT_FALSE(bad.equal());
    EXPECT_TRUE(bad.text().starts_with("tick " + std::to_string(changed) + " (")) << bad.text();
    EXPECT_NE(bad.text().find("differs first, in the stage 'force'; 1 of"), std::string::npos) << bad.text();
}

TEST_F(AgainTest, TheHandGlidesInAndOut) {
    StillHand own;
    PlaybackDevice hand(own);
    const auto sampleAt = [&](double time) {
        const DeviceSample sample = hand.sample(time);
        hand.apply({});
        return sample.position;
    };
    EXPECT_EQ(sampleAt(0.0), own.place);
    const glm::dvec3 begin(0.1, 0.0, 0.0), end(0.1, 0.1, 0.0);
    const auto path = std::make_shared<const RecordedPath>(
        std::vector<RecordedPath::Sample>{{0.0, begin, true}, {0.5, end, true}});
    hand.follow(path);
    glm::dvec3 last = own.place;
    double fastest = 0.0;
    for (double time = 1e-3; time < 2.0; time += 1e-3) {
        if (std::abs(time - 1.4) < 1e-6)
            hand.follow(nullptr);
        const glm::dvec3 now = sampleAt(time);
        fastest = std::max(fastest, glm::distance(now, last) / 1e-3);
        last = now;
        if (std::abs(time - 0.401) < 1e-6) {
            EXPECT_LT(glm::distance(now, begin), 1e-4);
        }
        if (std::abs(time - 0.651) < 1e-6) {
            EXPECT_LT(glm::distance(now, glm::mix(begin, end, 0.5)), 1e-3);
        }
        if (std::abs(time - 1.3) < 1e-6) {
            EXPECT_LT(glm::distance(now, end), 1e-12) << "rests where the recording ended";
        }
    }
    EXPECT_EQ(last, own.place);
    EXPECT_LT(fastest, 1.5 * 0.3 / PlaybackDevice::kGlideTime) << "no jump";
}

/// A simulated hand goes on where the scene has moved to, which it must know during the recording, too.
TEST(PlaybackDeviceTest, TheHandBehindARecordingKnowsWhatTheSceneShows) {
    StillHand own;
    PlaybackDevice hand(own);
    (void)hand.sample(0.0);
    hand.follow(std::make_shared<const RecordedPath>(
        std::vector<RecordedPath::Sample>{{0.0, own.place, true}, {0.5, own.place, true}}));
    for (int i = 1; i <= 2000; ++i) {
        if (i == 1000)
            hand.follow(nullptr);
        const double time = 1e-3 * i;
        hand.feel({.animation = 0.5 * time});
        (void)hand.sample(time);
        ASSERT_EQ(own.animation, 0.5 * time) << i;
    }
}

TEST_F(AgainTest, ADeviceThatIsHeldFeelsNothingOfWhatIsTouchedAgain) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    StillHand own; // in the air, with the force on
    PlaybackDevice hand(own);
    ServoLoop servo(portOf(hand), {.rateHz = 1000.0, .wantRealtime = false});
    servo.offerScene(scene.haptic, scene.source);
    std::vector<RecordedPath::Sample> samples;
    for (int i = 0; i < 1000; ++i)
        samples.push_back({1e-3 * i, overTheDoughnut(1e-3 * i), true});
    hand.follow(std::make_shared<const RecordedPath>(std::move(samples)));
    servo.start();
    double most = 0.0;
    while (servo.counters().ticks < 2000) {
        TickRecord record;
        while (servo.popRecord(record))
            most = std::max(most, glm::length(record.output.force));
        pause();
    }
    servo.stop();
    EXPECT_GT(most, 0.1) << "it touches";
    EXPECT_EQ(own.most, 0.0);
}

/// A device that is held within the model when the recorded hand has gone: its force comes back, no faster
/// than it may.
TEST_F(AgainTest, TheForceComesBackWithinTheDevicesSlew) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    DeviceLimits limits;
    limits.maxForceRate = 20.0; // N/s
    constexpr double kTick = 1e-3;
    StillHand own;
    PlaybackDevice hand(own);
    WorldState world;
    DeviceState state;
    NoStopwatch stopwatch;
    glm::dvec3 before(0.0);
    double steepest = 0.0, last = 0.0;
    uint64_t tick = 0;
    const auto run = [&](int ticks, const std::function<glm::dvec3(int)>& place) {
        for (int i = 0; i < ticks; ++i, ++tick) {
            own.place = place(i);
            const double time = kTick * static_cast<double>(tick);
            DeviceSample sample = hand.sample(time);
            sample.limits = limits;
            HapticOutput output;
            hapticStep(*scene.haptic, {},
                       {.tick = tick, .time = time, .dt = kTick, .hands = std::span(&sample, 1)}, world,
                       std::span(&state, 1), std::span(&output, 1), stopwatch);
            hand.apply(output.command);
            const glm::dvec3 force = output.command.force();
            steepest = std::max(steepest, glm::length(force - before) / kTick);
            last = glm::length(force);
            before = force;
        }
    };
    const glm::dvec3 pressed = overTheDoughnut(0.47);
    run(470, [](int i) { return overTheDoughnut(kTick * i); });
    const double held = last;
    EXPECT_GT(held, 0.1);
    hand.follow(std::make_shared<const RecordedPath>(
        std::vector<RecordedPath::Sample>{{0.0, pressed, true}, {0.5, pressed, true}}));
    run(1000, [&](int) { return pressed; });
    EXPECT_EQ(last, 0.0) << "nothing of what is touched again";
    hand.follow(nullptr);
    run(1000, [&](int) { return pressed; });
    EXPECT_EQ(last, 0.0) << "it is inside, where touch begins";
    run(470, [](int i) { return overTheDoughnut(kTick * (469 - i)); });
    EXPECT_EQ(last, 0.0);
    run(470, [](int i) { return overTheDoughnut(kTick * i); });
    EXPECT_GT(last, 0.5 * held) << "it is back";
    EXPECT_LE(steepest, 1.001 * limits.maxForceRate);
}

/// One's own hand is zoomed and presses; the recorded one is not zoomed. Between their frames lies no way.
TEST_F(AgainTest, GoingOverFromAZoomedHandBooksNoEnergy) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    constexpr double kTick = 1e-3;
    StillHand own;
    MappedDevice zoomed(own, 4.0, glm::dvec3(0.0, 0.0, -0.4));
    PlaybackDevice hand(zoomed);
    WorldState world;
    DeviceState state;
    HapticOutput output;
    NoStopwatch stopwatch;
    const Similarity map{4.0, glm::dquat(1.0, 0.0, 0.0, 0.0), glm::dvec3(0.0, 0.0, 1.2)};
    uint64_t tick = 0;
    double balance = 0.0, pressed = 0.0, fastest = 0.0;
    int unknown = 0;
    glm::dvec3 before(NAN);
    const auto run = [&](int ticks, const std::function<glm::dvec3(int)>& place) {
        for (int i = 0; i < ticks; ++i, ++tick) {
            own.place = map.inversePoint(place(i));
            const double time = kTick * static_cast<double>(tick);
            const DeviceSample sample = hand.sample(time);
            hapticStep(*scene.haptic, {},
                       {.tick = tick, .time = time, .dt = kTick, .hands = std::span(&sample, 1)}, world,
                       std::span(&state, 1), std::span(&output, 1), stopwatch);
            hand.apply(output.command);
            balance = std::max(balance, state.limiter.passivity.balance);
            pressed = glm::length(output.command.force());
            unknown += sample.valid ? 0 : 1;
            if (tick > 0)
                fastest = std::max(fastest, glm::distance(sample.inWorkspace(), before) / kTick);
            before = sample.inWorkspace();
        }
    };
    const glm::dvec3 there = overTheDoughnut(0.47);
    run(470, [](int i) { return overTheDoughnut(kTick * i); });
    EXPECT_GT(pressed, 0.1);
    EXPECT_EQ(unknown, 0);
    balance = 0.0;
    const auto path = std::make_shared<const RecordedPath>(
        std::vector<RecordedPath::Sample>{{0.0, there, true}, {0.5, there, true}});
    hand.follow(path);
    run(1000, [&](int) { return there; });
    hand.follow(nullptr);
    run(1000, [&](int) { return there; });
    EXPECT_EQ(pressed, 0.0) << "it is inside, where touch begins";
    run(470, [](int i) { return overTheDoughnut(kTick * (469 - i)); });
    run(470, [](int i) { return overTheDoughnut(kTick * i); });
    EXPECT_GT(pressed, 0.1) << "it is back";
    EXPECT_EQ(unknown, 2) << "a tick each way";
    EXPECT_LT(balance, kNoticedEnergy);
    EXPECT_LT(fastest, 0.5) << "the HIP does not jump";
}

TEST(RecordedPathTest, BeginsWhereWhatMovesWasAndGoesRound) {
    const RecordedPath path({{0.0, glm::dvec3(0.0), true}, {1.0, glm::dvec3(0.01), true}},
                            {.repeats = true, .period = 4.0, .phase = 11.0});
    EXPECT_LT(path.secondsAt(5.0), 0.0) << "nobody has taken it up";
    path.begin(5.0);
    EXPECT_NEAR(path.begun(), 7.0, 1e-12);
    EXPECT_EQ(path.at(6.0).position, glm::dvec3(0.0)) << "waits at its begin";
    EXPECT_NEAR(path.at(7.25).position.x, 0.0025, 1e-12);
    EXPECT_NEAR(path.lap(), 4.0, 1e-12) << "every round is in phase";
    EXPECT_NEAR(path.secondsAt(11.25), 0.25, 1e-12);
    EXPECT_NEAR(path.at(15.5).position.x, 0.005, 1e-12);
    EXPECT_EQ(path.at(10.0).position, glm::dvec3(0.0)) << "rests where it begins";
    const glm::dvec3 back = path.at(8.0 + 0.5 * PlaybackDevice::kGlideTime).position;
    EXPECT_NEAR(back.x, 0.005, 1e-12) << "half of the way back";
    const auto lap = [](double seconds, double period) {
        return RecordedPath({{0.0, glm::dvec3(0.0), true}, {seconds, glm::dvec3(0.01), true}},
                            {.repeats = true, .period = period})
            .lap();
    };
    EXPECT_NEAR(lap(1.0, 0.0), 1.0 + PlaybackDevice::kGlideTime, 1e-12) << "nothing moves";
    EXPECT_NEAR(lap(1.0, 0.5), 1.5, 1e-12);
    EXPECT_NEAR(lap(1.6, 0.5), 2.0, 1e-12) << "a multiple already";
    EXPECT_NEAR(lap(1.7, 0.5), 2.5, 1e-12);
}

/// What the window's turn does: lets the servo touch with the hand and looks at what comes of it.
class AgainServo {
  public:
    explicit AgainServo(const HapticSettings& settings)
        : rig_([this](double time) { return hand_.sample(time); },
               {.rateHz = 1000.0, .ringCapacity = 1 << 14, .wantRealtime = false}) {
        rig_.servo.setSettings(settings);
        rig_.offer(touchedScene("doughnut.glb"));
    }
    TouchAgain::Means touch(const std::shared_ptr<const Timeline>& timeline, const TouchAgain::Part& part) {
        TouchAgain again(hand_);
        again.start(timeline, part);
        size_t seen = 0;
        TouchAgain::Means means;
        while (again.running()) {
            if (!again.seconds())
                pause(); // the worker may be reading, and steps wait for no clock
            rig_.steps(20);
            for (; seen < rig_.records.size(); ++seen)
                history_.add(rig_.records[seen], false);
            again.update(history_, rig_.records.back().time);
            if (again.means().ticks >= means.ticks)
                means = again.means();
        }
        rig_.finish();
        return means;
    }

  private:
    StillHand own_;
    PlaybackDevice hand_{own_};
    ForceHistory history_{10000};
    RecordedServo rig_;
};

TEST_F(AgainTest, TheSameHandFeelsTheSameAndWithOtherSettingsSomethingElse) {
    (void)record(); // 2.25 s
    const auto timeline = timelineOf(file_);
    const TouchAgain::Part part{.first = timeline->indexAt(0.5), .last = timeline->indexAt(1.6)};
    const TouchAgain::Means same = AgainServo(HapticSettings{}).touch(timeline, part);
    ASSERT_GT(same.ticks, 500u);
    EXPECT_GT(same.recorded, 0.05);
    EXPECT_NEAR(same.now, same.recorded, 0.1 * same.recorded);
    HapticSettings soft;
    soft.stiffness = 100.0;
    const TouchAgain::Means softer = AgainServo(soft).touch(timeline, part);
    EXPECT_LT(softer.now, 0.5 * softer.recorded);
}

} // namespace
} // namespace touchstone::test::again_test
