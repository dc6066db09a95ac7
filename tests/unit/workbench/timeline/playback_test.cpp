#include "tests/unit/workbench/timeline/recordings.h"
#include "workbench/timeline/playback.h"

#include <gtest/gtest.h>

namespace touchstone::test::playback_test {
namespace {

class PlaybackTest : public testing::Test {
  protected:
    /// A second at 1 kHz, a gap of two seconds, and another second.
    PlaybackTest() {
        const auto nothing = [](size_t) { return 0.0; };
        writeItems(scratch_ / "r.tsrec",
                   {RecordedSettings{1, {}}, ticksFrom(0.0, 1000, nothing), RecordedLoss{2000},
                    ticksFrom(3.0, 1000, nothing), RecordedEnd{2000}});
        timeline_ = timelineOf(scratch_ / "r.tsrec");
    }
    ScratchFolder scratch_;
    std::shared_ptr<const Timeline> timeline_;
};

TEST_F(PlaybackTest, StepsByTicksAndStaysWithin) {
    Playback at(timeline_);
    at.step(-1);
    EXPECT_EQ(at.cursor(), 0u);
    at.step(1);
    EXPECT_EQ(at.cursor(), 1u);
    at.step(5000);
    EXPECT_EQ(at.cursor(), 1999u);
    at.step(-999);
    EXPECT_EQ(at.cursor(), 1000u);
    at.toBegin();
    EXPECT_EQ(at.cursor(), 0u);
    at.toEnd();
    EXPECT_EQ(at.cursor(), 1999u);
}

TEST_F(PlaybackTest, StepsBySecondsAlsoOverAGap) {
    Playback at(timeline_);
    at.stepSeconds(0.1);
    EXPECT_EQ(at.cursor(), 100u);
    at.seek(0.95);
    at.stepSeconds(0.1);
    EXPECT_EQ(at.cursor(), 999u) << "the last one before the gap";
    at.stepSeconds(0.1);
    EXPECT_EQ(at.cursor(), 1000u) << "and the first one behind it";
    at.stepSeconds(-0.1);
    EXPECT_EQ(at.cursor(), 999u);
    at.toBegin();
    at.stepSeconds(-0.1);
    EXPECT_EQ(at.cursor(), 0u);
    at.toEnd();
    at.stepSeconds(0.1);
    EXPECT_EQ(at.cursor(), 1999u);
}

TEST_F(PlaybackTest, PlaysAtItsSpeedAndStopsAtTheEnd) {
    for (const double speed : Playback::kSpeeds) {
        Playback at(timeline_);
        at.setSpeed(speed);
        at.play(true);
        for (int frame = 0; frame < 6; ++frame)
            at.advance(1.0 / 30.0);
        EXPECT_NEAR(at.seconds(), 0.2 * speed, 1.1e-3) << speed;
        EXPECT_TRUE(at.playing());
    }
    Playback at(timeline_);
    at.play(true);
    at.advance(0.9995);
    EXPECT_EQ(at.cursor(), 1000u) << "nobody waits in a gap";
    at.advance(0.5);
    EXPECT_NEAR(at.seconds(), 3.5, 1.1e-3);
    at.advance(9.0);
    EXPECT_EQ(at.cursor(), 1999u);
    EXPECT_FALSE(at.playing());
    at.play(true);
    EXPECT_EQ(at.cursor(), 0u) << "from the end it begins again";
    at.play(false);
    at.advance(1.0);
    EXPECT_EQ(at.cursor(), 0u);
}

TEST_F(PlaybackTest, SlowMotionIsNotLostBetweenTicks) {
    Playback at(timeline_);
    at.setSpeed(0.1);
    at.play(true);
    for (int frame = 0; frame < 1000; ++frame)
        at.advance(1e-3); // a tenth of a tick
    EXPECT_NEAR(static_cast<double>(at.cursor()), 100.0, 1.0);
}

TEST_F(PlaybackTest, GoesRoundBetweenItsMarks) {
    Playback at(timeline_);
    at.seek(0.2);
    at.markBegin();
    EXPECT_FALSE(at.loops());
    at.seek(0.5);
    at.markEnd();
    ASSERT_TRUE(at.loops());
    EXPECT_EQ(at.first(), 200u);
    EXPECT_EQ(at.last(), 500u);
    at.play(true);
    EXPECT_EQ(at.cursor(), 200u);
    for (int frame = 0; frame < 100; ++frame) {
        at.advance(0.033);
        ASSERT_GE(at.cursor(), 200u);
        ASSERT_LE(at.cursor(), 500u);
        ASSERT_TRUE(at.playing());
    }
    // 3.3 s in rounds of 0.3 s
    EXPECT_NEAR(at.seconds(), 0.2, 5e-3);
    at.seek(0.7);
    at.advance(0.01);
    EXPECT_NEAR(at.seconds(), 0.21, 2e-3) << "back into the loop";
    at.seek(0.6);
    at.markBegin();
    EXPECT_FALSE(at.loops()) << "the end was before it";
    EXPECT_EQ(at.last(), 1999u);
    at.clearMarks();
    EXPECT_EQ(at.first(), 0u);
}

} // namespace
} // namespace touchstone::test::playback_test
