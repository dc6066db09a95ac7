// Contact locations in recordings: replayed to the last bit from the start and from the middle, and a
// location that was changed is found.

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace touchstone::test::location_replay_test {
namespace {

/// Two hands over the doughnut, both turning; one has a display, which comes and goes and changes its limits.
class LocationReplay : public testing::Test {
  protected:
    struct Hand {
        bool mirrored = false, displays = false;
        double time = 0.0;
    };

    static DevicePort portOf(Hand& hand) {
        return {.context = &hand,
                .sample =
                    [](void* context, double time) noexcept {
                        Hand& own = *static_cast<Hand*>(context);
                        own.time = time;
                        DeviceSample sample = at(overTheDoughnut(time));
                        if (own.mirrored)
                            sample.position.y = -sample.position.y;
                        sample.orientation = glm::normalize(
                            glm::dquat(1.0, 0.3 * std::sin(7.0 * time), 0.2, 0.4 * std::sin(11.0 * time)));
                        return sample;
                    },
                .apply = [](void*, const DeviceCommand&) noexcept {},
                .pad =
                    [](void* context) noexcept {
                        const Hand& own = *static_cast<Hand*>(context);
                        const bool gone = std::fmod(own.time, 1.3) > 1.2;
                        return own.displays && !gone
                                   ? PadLimits{.reach = own.time > 1.0 ? 0.006 : 0.008, .rate = 0.05}
                                   : PadLimits{};
                    },
                .applyPad = [](void*, const PadCommand&) noexcept {}};
    }

    LocationReplay() {
        enterFloatMode();
        scene_ = touchedScene("doughnut.glb");
        recorder_.sceneOffered(servo_.offerScene(scene_.haptic, scene_.source), scene_.identity);
    }

    void steps(uint64_t count) {
        for (uint64_t i = 0; i < count; ++i) {
            (void)servo_.step(++number_);
            TickRecord record;
            while (servo_.popRecord(record)) {
                recorder_.take(record);
                shown_ += record.pad.limits.reach > 0.0 ? 1 : 0;
                moved_ += record.pad.location != record.pad.before ? 1 : 0;
            }
        }
        recorder_.flush();
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec", changed_ = scratch_ / "changed.tsrec";
    TouchedScene scene_;
    Hand first_{.displays = true}, second_{.mirrored = true, .displays = true};
    ServoLoop servo_{{portOf(first_), portOf(second_)}, {.checkpointSeconds = 0.25}};
    ServoRecorder recorder_{servo_};
    uint64_t number_ = 0;
    size_t shown_ = 0, moved_ = 0;
};

TEST_F(LocationReplay, IsEqualFromTheStartAndFromTheMiddle) {
    recorder_.start(file_, "test");
    steps(1500);
    servo_.forceSwitch().takeAway(true); // the displays hold
    steps(300);
    ASSERT_TRUE(servo_.forceSwitch().giveBack(servo_.forceSwitch().state()));
    steps(700);
    recorder_.stop();
    recorder_.start(scratch_ / "middle.tsrec", "test");
    const size_t before = moved_;
    steps(1000);
    recorder_.finish();
    std::printf("%zu locations, %zu of them on their way\n", shown_, moved_);
    EXPECT_GT(shown_, 5000u);
    EXPECT_GT(moved_, 1000u);
    EXPECT_GT(moved_, before);
    const ReplayReport whole = replayOf(file_, {scene_});
    expectEqualReplay(whole);
    EXPECT_EQ(whole.ticks, 2500u);
    EXPECT_EQ(whole.hands, 2u);
    const ReplayReport middle = replayOf(scratch_ / "middle.tsrec", {scene_});
    expectEqualReplay(middle);
    EXPECT_EQ(middle.ticks, 1000u);
}

TEST_F(LocationReplay, FindsAChangedLocationAndAChangedState) {
    recorder_.start(file_, "test");
    steps(1500);
    recorder_.finish();
    const std::vector<RecordedItem> items = itemsOf(file_);
    size_t chunks = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        const auto* const locations = std::get_if<RecordedLocations>(&items[i]);
        if (locations == nullptr)
            continue;
        if (++chunks % 4 != 1)
            continue;
        std::vector<RecordedItem> changed = items;
        auto& own = std::get<RecordedLocations>(changed[i]);
        const size_t k = own.shown.size() / 2;
        own.shown[k].location.y = std::nextafter(own.shown[k].location.y, 1.0);
        writeItems(changed_, changed);
        const ReplayReport report = replayOf(changed_, {scene_});
        ASSERT_TRUE(report.first.has_value());
        EXPECT_EQ(report.first->stage, "contact location");
        EXPECT_EQ(report.first->tick, own.shown[k].tick);
        EXPECT_EQ(report.first->hand, own.hand);
        EXPECT_EQ(report.differing, 1u);
    }
    EXPECT_GT(chunks, 8u);
    // The place before a checkpoint is a state of its own.
    std::vector<RecordedItem> changed = items;
    const RecordedLocations* last = nullptr;
    for (size_t i = 0; i + 1 < changed.size(); ++i)
        if (auto* const own = std::get_if<RecordedLocations>(&changed[i]);
            own != nullptr && own->hand == 0 && own->shown.front().tick == 1001) {
            own->before.x += 1e-9;
            last = own;
        }
    ASSERT_NE(last, nullptr) << "a checkpoint each quarter of a second";
    writeItems(changed_, changed);
    const ReplayReport report = replayOf(changed_, {scene_});
    ASSERT_TRUE(report.first.has_value());
    EXPECT_EQ(report.first->stage, "state");
    EXPECT_EQ(report.first->tick, last->shown.front().tick);
}

TEST_F(LocationReplay, AHandWithoutADisplayHasNone) {
    first_.displays = second_.displays = false;
    recorder_.start(file_, "test");
    steps(300);
    recorder_.finish();
    EXPECT_EQ(shown_, 0u);
    for (const RecordedItem& item : itemsOf(file_))
        EXPECT_FALSE(std::holds_alternative<RecordedLocations>(item)) << "its file is as before";
    expectEqualReplay(replayOf(file_, {scene_}));
}

TEST(RecordedLocationsFormat, WhatCannotBeIsRefused) {
    size_t name = 0;
    while (name < kChunkNames.size() && kChunkNames[name] != "LOCA")
        ++name;
    ASSERT_LT(name, kChunkNames.size());
    const RecordedLocations good{1, {1e-3, 0.0}, {{7, {0.008, 0.1}, {1e-3, 2e-3}}}};
    EXPECT_NO_THROW((void)decode(name, encode(good)));
    for (int wrong = 0; wrong < 4; ++wrong) {
        RecordedLocations bad = good;
        if (wrong == 0)
            bad.hand = 4;
        if (wrong == 1)
            bad.before.x = INFINITY;
        if (wrong == 2)
            bad.shown[0].location.y = NAN;
        std::vector<std::byte> bytes = encode(bad);
        if (wrong == 3)
            bytes.pop_back();
        EXPECT_THROW((void)decode(name, bytes), Error) << wrong;
    }
}

} // namespace
} // namespace touchstone::test::location_replay_test
