// What a person sees of a recording: no peak is lost, what happened is marked, and a file that is broken says
// so.

#include "engine/core/error.h"
#include "tests/unit/workbench/timeline/recordings.h"
#include "workbench/timeline/recording_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace touchstone::test::timeline_test {
namespace {

TEST(MinMaxPyramid, IsWhatLookingAtEveryValueGives) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(-5.0f, 5.0f);
    for (const size_t size : {1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u, 70000u}) {
        std::vector<float> values(size);
        std::ranges::generate(values, [&] { return value(random); });
        const MinMaxPyramid pyramid(values);
        std::uniform_int_distribution<size_t> at(0, size - 1);
        for (int i = 0; i < 400; ++i) {
            const size_t one = at(random), other = at(random), first = std::min(one, other),
                         last = std::max(one, other);
            const auto extremes = std::minmax_element(values.begin() + static_cast<long>(first),
                                                      values.begin() + static_cast<long>(last) + 1);
            ASSERT_EQ(pyramid.over(first, last + 1), (MinMax{*extremes.first, *extremes.second}))
                << size << ": " << first << ", " << last;
        }
        ASSERT_EQ(pyramid.over(0, size),
                  (MinMax{*std::ranges::min_element(values), *std::ranges::max_element(values)}));
    }
}

class TimelineTest : public testing::Test {
  protected:
    std::shared_ptr<const Timeline> made(const std::vector<RecordedItem>& items) {
        writeItems(file_, items);
        return timelineOf(file_);
    }
    std::string problem() {
        try {
            (void)timelineOf(file_);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
};

const auto kNothing = [](size_t) { return 0.0; };

TEST_F(TimelineTest, KnowsItsCurvesAndWhereItTouches) {
    const auto newton = [](size_t i) {
        return i >= 100 && i < 130 ? 0.5 + 0.01 * static_cast<double>(i) : 0.0;
    };
    const auto timeline = made({recordingOrigin("test", 1000.0), RecordedSettings{1, {}},
                                ticksFrom(7.0, 400, newton), RecordedEnd{400}});
    ASSERT_EQ(timeline->size(), 400u);
    EXPECT_NEAR(timeline->length(), 0.399, 1e-9);
    for (size_t i = 0; i < 400; ++i) {
        EXPECT_FLOAT_EQ(timeline->force()[i], static_cast<float>(newton(i)));
        EXPECT_FLOAT_EQ(timeline->depth()[i], static_cast<float>(1e-3 * newton(i)));
        EXPECT_NEAR(timeline->seconds(i), 1e-3 * static_cast<double>(i), 1e-9);
        EXPECT_EQ(timeline->indexAt(timeline->seconds(i)), i);
        EXPECT_EQ(timeline->touches(i, i + 1), newton(i) > 0.0) << i;
    }
    EXPECT_FALSE(timeline->touches(0, 100));
    EXPECT_TRUE(timeline->touches(0, 101));
    EXPECT_TRUE(timeline->touches(129, 400));
    EXPECT_FALSE(timeline->touches(130, 400));
    EXPECT_EQ(timeline->indexAt(-1.0), 0u);
    EXPECT_EQ(timeline->indexAt(9.0), 399u);
    EXPECT_TRUE(timeline->marks().empty());
    EXPECT_TRUE(timeline->warnings().empty());
}

TEST_F(TimelineTest, MarksWhatChangedAndWhatIsMissing) {
    HapticSettings smooth;
    smooth.friction = FrictionMode::Off;
    smooth.stiffness = 800.0;
    RecordedScene first{1, {}}, second{2, {}};
    first.identity.path = "/models/cup.glb";
    second.identity.path = "/models/ball.glb";
    RecordedTicks touched = ticksFrom(1.0, 100, kNothing), other = ticksFrom(1.1, 100, kNothing, 2);
    for (RecordedTick& tick : touched.ticks)
        tick.scene = 1;
    for (RecordedTick& tick : other.ticks)
        tick.scene = 2;
    const auto timeline =
        made({recordingOrigin("test", 1000.0), first, RecordedSettings{1, {}}, touched, RecordedLoss{17},
              second, RecordedSettings{2, smooth}, other, RecordedNote{150, "a fault"}, RecordedEnd{200}});
    ASSERT_EQ(timeline->marks().size(), 4u);
    using Kind = TimelineMark::Kind;
    const auto expectMark = [&](size_t i, Kind kind, size_t index, const std::string& text) {
        const TimelineMark& mark = timeline->marks()[i];
        EXPECT_EQ(mark.kind, kind) << i;
        EXPECT_EQ(mark.index, index) << i;
        EXPECT_EQ(mark.text, text) << i;
    };
    expectMark(0, Kind::Gap, 100, "17 ticks were not recorded");
    expectMark(1, Kind::Scene, 100, "ball.glb");
    expectMark(2, Kind::Settings, 100, "friction zilles to off, stiffness 0 to 800");
    expectMark(3, Kind::Note, 200, "a fault");
    EXPECT_EQ(timeline->sceneOf(99), 1u);
    EXPECT_EQ(timeline->sceneOf(100), 2u);
    EXPECT_EQ(timeline->settingsOf(99), HapticSettings{});
    EXPECT_EQ(timeline->settingsOf(199), smooth);
    EXPECT_EQ(timeline->lost(), 17u);
    EXPECT_EQ(timeline->warnings().size(), 1u);
}

TEST_F(TimelineTest, GoesOnWhereTheServoBeganToCountAnew) {
    const auto timeline =
        made({RecordedSettings{1, {}}, ticksFrom(5.0, 10, kNothing), ticksFrom(0.0, 10, kNothing),
              ticksFrom(9.0, 10, kNothing), ticksFrom(1e9, 10, kNothing), RecordedEnd{40}});
    for (size_t i = 1; i < timeline->size(); ++i)
        ASSERT_GT(timeline->seconds(i), timeline->seconds(i - 1)) << i;
    EXPECT_NEAR(timeline->seconds(10) - timeline->seconds(9), 1e-3, 1e-9) << "counted anew";
    EXPECT_NEAR(timeline->seconds(20) - timeline->seconds(19), 9.0 - 0.009, 1e-9)
        << "nothing was recorded meanwhile";
    EXPECT_NEAR(timeline->seconds(30) - timeline->seconds(29), 1e-3, 1e-9) << "a clock that was set";
}

TEST_F(TimelineTest, SegmentsCoverItAndBeginAtCheckpoints) {
    std::vector<RecordedItem> items{RecordedSettings{1, {}}, TouchCheckpoint{}};
    for (int block = 0; block < 50; ++block)
        items.emplace_back(ticksFrom(0.2 * block, 200, kNothing));
    items.emplace_back(TouchCheckpoint{.tick = 10000});
    items.emplace_back(ticksFrom(10.0, 300, kNothing));
    items.emplace_back(RecordedEnd{10300});
    const auto timeline = made(items);
    const auto& segments = timeline->segments();
    ASSERT_EQ(segments.size(), 4u);
    size_t next = 0;
    for (size_t i = 0; i < segments.size(); ++i) {
        EXPECT_EQ(segments[i].first, next);
        EXPECT_EQ(segments[i].checkpoint, i == 0 || i == 3) << i;
        next = timeline->endOf(i);
        EXPECT_EQ(timeline->segmentOf(segments[i].first), i);
        EXPECT_EQ(timeline->segmentOf(next - 1), i);
    }
    EXPECT_EQ(next, timeline->size());
    EXPECT_EQ(segments[3].first, 10000u);
}

/// Edits of the scene begin no segment before the bodies that belong to them; those of a scene without bodies
/// do, also where the scene before had some.
TEST_F(TimelineTest, EditsBeginSegmentsWhereTheirBodiesAre) {
    std::vector<RecordedItem> items{RecordedSettings{1, {}}, RecordedScene{1, {}},
                                    TouchCheckpoint{.scene = 1}, RecordedBodies{}};
    double time = 0.0;
    const auto ticksOn = [&] {
        items.emplace_back(ticksFrom(time, 1200, kNothing));
        time += 1.2;
    };
    const auto edit = [&](uint32_t root, uint32_t number, bool bodies) {
        items.emplace_back(RecordedSculpt{.scene = number, .root = root, .entries = {}});
        const auto tick = static_cast<uint64_t>(1000.0 * time + 0.5);
        items.emplace_back(TouchCheckpoint{.tick = tick, .scene = number});
        if (bodies)
            items.emplace_back(RecordedBodies{tick, {}});
        ticksOn();
    };
    ticksOn();
    edit(1, 2, true);
    edit(1, 3, false);
    items.emplace_back(RecordedScene{4, {}});
    items.emplace_back(TouchCheckpoint{.tick = 3600, .scene = 4});
    ticksOn();
    edit(4, 5, false);
    edit(4, 6, false);
    items.emplace_back(RecordedEnd{7200});
    std::vector<size_t> begins;
    const auto timeline = made(items);
    for (const TimelineSegment& segment : timeline->segments()) {
        begins.push_back(segment.first);
        EXPECT_TRUE(segment.checkpoint) << segment.first;
    }
    EXPECT_EQ(begins, (std::vector<size_t>{0, 1200, 3600, 4800, 6000}));
}

std::vector<RecordedItem> threeBlocks() {
    return {recordingOrigin("touch", 1000.0), RecordedSettings{1, {}},       ticksFrom(0.0, 4, kNothing),
            ticksFrom(0.004, 4, kNothing),    ticksFrom(0.008, 4, kNothing), RecordedEnd{12}};
}

TEST_F(TimelineTest, AFileCutAnywhereShowsWhatIsThereOrSaysWhy) {
    (void)made(threeBlocks());
    const std::string whole = readFile(file_);
    for (size_t length = 0; length < whole.size(); length += 3) {
        writeTextFile(file_, whole.substr(0, length));
        try {
            const auto timeline = timelineOf(file_);
            ASSERT_EQ(timeline->size() % 4, 0u) << length;
            ASSERT_NE(timeline->warnings().back().find("cut off"), std::string::npos) << length;
        } catch (const Error& error) {
            const std::string said = error.what();
            ASSERT_TRUE(said.find("r.tsrec") != std::string::npos) << said;
            ASSERT_TRUE(said.find("no ticks in it") != std::string::npos ||
                        said.find("is empty") != std::string::npos ||
                        said.find("is no recording") != std::string::npos)
                << length << ": " << said;
        }
    }
}

TEST_F(TimelineTest, ASpoiltByteIsAMarkOrAnErrorThatNamesTheFile) {
    (void)made(threeBlocks());
    const std::string whole = readFile(file_);
    size_t shown = 0;
    for (size_t at = 0; at < whole.size(); at += 3) {
        std::string spoilt = whole;
        spoilt[at] = static_cast<char>(spoilt[at] ^ 0x40);
        writeTextFile(file_, spoilt);
        try {
            const auto timeline = timelineOf(file_);
            ASSERT_GE(timeline->size(), 8u) << at;
            ASSERT_FALSE(timeline->warnings().empty()) << at;
            ++shown;
        } catch (const Error& error) {
            ASSERT_NE(std::string(error.what()).find("r.tsrec"), std::string::npos) << error.what();
        }
    }
    EXPECT_GT(shown, whole.size() / 6) << "most bytes are those of ticks";
}

TEST_F(TimelineTest, OtherFilesSayWhatTheyAre) {
    writeTextFile(file_, "t,x,y,z\n0,0,0,0\n");
    EXPECT_NE(problem().find("is no recording"), std::string::npos);
    EXPECT_TRUE(isRecording(file_)) << "it is called one: then what is wrong with it is worth saying";
    writeTextFile(scratch_ / "model.glb", "glTF");
    EXPECT_FALSE(isRecording(scratch_ / "model.glb"));
    writeItems(scratch_ / "renamed.glb", threeBlocks());
    EXPECT_TRUE(isRecording(scratch_ / "renamed.glb")) << "by what is in it";
    EXPECT_FALSE(isRecording(scratch_ / "nothing.glb"));
    EXPECT_FALSE(isRecording(scratch_.path()));
    std::filesystem::remove(file_);
    EXPECT_NE(problem().find("cannot be read"), std::string::npos);
    writeItems(file_, {recordingOrigin("touch", 1000.0), RecordedEnd{0}});
    EXPECT_NE(problem().find("there are no ticks in it"), std::string::npos);
    RecordedTicks unsettled = ticksFrom(0.0, 3, kNothing, 9);
    writeItems(file_, {RecordedSettings{1, {}}, unsettled, RecordedEnd{3}});
    EXPECT_NE(problem().find("settings that are not there"), std::string::npos);
}

TEST(BackgroundJobTest, NothingComesOfWhatIsGivenUp) {
    BackgroundJob<int> job;
    job.start([](JobProgress& progress) {
        for (;;)
            progress.at(0.5);
        return 1;
    });
    EXPECT_TRUE(job.wanted());
    job.abandon();
    EXPECT_FALSE(job.wanted());
    std::optional<int> result;
    while (job.busy())
        result = job.take();
    EXPECT_FALSE(result);
}

TEST_F(TimelineTest, TheListSaysOfEachWhatItIs) {
    (void)made(threeBlocks());
    RecordedScene scene{1, {}};
    scene.identity.path = "/models/cup.glb";
    std::vector<RecordedItem> touched = threeBlocks();
    touched.insert(touched.begin() + 1, scene);
    touched.pop_back();
    writeItems(scratch_ / "cut.tsrec", touched);
    writeTextFile(scratch_ / "broken.tsrec", "hm");
    writeTextFile(scratch_ / "live-7-a.tsrec", "being written");
    writeTextFile(scratch_ / "other.txt", "not one");
    const auto now = std::filesystem::last_write_time(file_);
    std::filesystem::last_write_time(scratch_ / "cut.tsrec", now + std::chrono::seconds(10));
    std::filesystem::last_write_time(scratch_ / "broken.tsrec", now - std::chrono::seconds(10));
    const auto list = recordingsIn({scratch_.path(), scratch_ / "nowhere"}, {}, 10);
    ASSERT_EQ(list.size(), 3u);
    EXPECT_EQ(list[0].file.filename(), "cut.tsrec");
    EXPECT_EQ(list[0].model, "cup.glb");
    EXPECT_FALSE(list[0].wholeLength);
    EXPECT_EQ(list[1].file, file_);
    EXPECT_EQ(list[1].model, "");
    EXPECT_EQ(list[1].madeBy, "touch");
    EXPECT_TRUE(list[1].wholeLength);
    EXPECT_NEAR(list[1].seconds, 0.012, 1e-9);
    EXPECT_EQ(list[1].date.size(), std::string("2026-03-01 14:05").size());
    EXPECT_EQ(list[1].problem, "");
    EXPECT_NE(list[2].problem.find("is no recording"), std::string::npos);
    EXPECT_EQ(recordingsIn({scratch_.path()}, list, 1).size(), 1u);
}

} // namespace
} // namespace touchstone::test::timeline_test
