// A servo and a sound card that are both made up: two clocks, and what happens between them.

#include "sound/live_sound.h"
#include "tests/support/allocation_counter.h"
#include "tests/unit/sound/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::test::live_sound_test {
namespace {

constexpr double kRate = 48000.0, kTurn = 2.0 * std::numbers::pi;

/// A card that asks for blocks and a servo that ticks, on the clock of the servo.
class Room {
  public:
    explicit Room(double tickRate = 1000.0, size_t block = 480, double cardSpeed = 1.0)
        : player(feed, kRate), tickRate_(tickRate), block_(block), cardSpeed_(cardSpeed) {
        feed.listen(true);
        player.setVolume(1.0f);
    }

    /// Lets `seconds` go by with a tone of 100 Hz in a stroke; `ticking` false: the servo stands still.
    void pass(double seconds, bool ticking = true, double amplitude = 0.1) {
        const double end = time_ + seconds;
        while (time_ < end) {
            const double card = static_cast<double>(blocks_ * block_) / (kRate * cardSpeed_);
            const double servo = static_cast<double>(ticks_) / tickRate_;
            time_ = std::min(card, servo);
            if (servo <= card) {
                const double t = servo;
                if (ticking)
                    feed.add({.dt = 1.0 / tickRate_,
                              .position = {0.1 * t, 0.0, 0.0},
                              .force = {0.0, 1.0 + amplitude * std::sin(kTurn * 100.0 * t), 0.0}});
                ++ticks_;
            } else {
                std::vector<SoundFrame> frames(block_);
                player.fill(frames);
                heard.insert(heard.end(), frames.begin(), frames.end());
                ++blocks_;
            }
        }
    }
    [[nodiscard]] std::span<const SoundFrame> last(double seconds) const {
        return std::span(heard).last(static_cast<size_t>(seconds * kRate));
    }

    SoundFeed feed;
    SoundPlayer player;
    std::vector<SoundFrame> heard;

  private:
    double tickRate_;
    size_t block_;
    double cardSpeed_, time_ = 0.0;
    size_t ticks_ = 0, blocks_ = 0;
};

double largestStep(std::span<const SoundFrame> frames) {
    double most = 0.0;
    for (size_t i = 0; i + 1 < frames.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(frames[i + 1].left - frames[i].left)));
    return most;
}

TEST(LiveSound, PlaysWithoutGapsAndSoonAtEveryRateAndBlock) {
    for (const double tickRate : {500.0, 1000.0, 4000.0})
        for (const size_t block : {128, 480, 1024}) {
            Room room(tickRate, block);
            room.pass(3.0);
            const SoundPlayer::Figures figures = room.player.figures();
            EXPECT_EQ(figures.runsDry, 0u) << tickRate << ", " << block;
            EXPECT_EQ(figures.leftOut, 0u) << tickRate << ", " << block;
            const std::vector<float> left = leftOf(room.last(1.0));
            EXPECT_EQ(strongestTone(left, kRate, 50.0, 450.0, 10.0), 100.0);
            // A block, what is kept for jitter, and what the synthesizer itself takes.
            EXPECT_LT(figures.latency, 1.5 * static_cast<double>(block) / kRate +
                                           2.0 * SoundPlayer::kCushion + Synthesizer::delay(1.0 / tickRate) +
                                           2.0 / tickRate);
        }
}

TEST(LiveSound, ATapIsHeardAsLateAsItSays) {
    for (const size_t block : {128, 480, 1024}) {
        Room room(1000.0, block);
        room.pass(1.0, true, 0.0);
        EXPECT_LT(loudest(room.heard), 1e-6);
        room.feed.add({.force = {0.0, 3.0, 0.0}}); // a tap between the ticks
        room.pass(0.2, true, 0.0);
        const auto first = std::ranges::find_if(
            room.heard, [](const SoundFrame& frame) { return std::abs(frame.left) > 0.2f; });
        const double late = static_cast<double>(first - room.heard.begin()) / kRate - 1.0;
        // Until the card takes the block it waits; within it, every frame is as late as the next one.
        EXPECT_NEAR(late, room.player.figures().latency, 0.004) << block;
    }
}

TEST(LiveSound, FollowsACardWhoseClockIsOff) {
    for (const double cardSpeed : {0.9995, 1.0005}) {
        Room room(1000.0, 480, cardSpeed);
        room.pass(60.0);
        EXPECT_EQ(room.player.figures().runsDry, 0u) << cardSpeed;
        EXPECT_EQ(room.player.figures().leftOut, 0u) << cardSpeed;
        EXPECT_LT(largestStep(room.last(50.0)), 0.012) << "the tone of 100 Hz and nothing else";
    }
}

TEST(LiveSound, FadesWhereTheServoStandsStillAndComesBack) {
    Room room;
    room.pass(1.0);
    const double tone = largestStep(room.last(0.5));
    EXPECT_GT(tone, 0.003);
    room.pass(0.5, false);
    EXPECT_EQ(room.player.figures().runsDry, 1u);
    EXPECT_EQ(loudest(room.last(0.3)), 0.0);
    room.pass(1.0);
    EXPECT_EQ(strongestTone(leftOf(room.last(0.5)), kRate, 50.0, 450.0), 100.0);
    // A fade of 4 ms takes at most 1/192 of what is heard a frame, besides the tone itself.
    EXPECT_LT(largestStep(room.heard), tone + 1.0 / (SoundPlayer::kFade * kRate) + 1e-3);
}

TEST(LiveSound, LeavesOutWhatIsOldWhereTheCardStoodStill) {
    Room room;
    room.pass(1.0);
    for (int i = 0; i < 400; ++i) // 0.4 s of ticks that nobody took
        room.feed.add({.position = {0.1, 0.0, 0.0}, .force = {0.0, 1.0, 0.0}});
    room.pass(0.5);
    EXPECT_EQ(room.player.figures().leftOut, 1u);
    EXPECT_LT(room.player.figures().latency, 0.05);
}

TEST(LiveSound, ALateTickIsNoReasonToLeaveOutGoodOnes) {
    Room room;
    room.pass(1.0);
    room.feed.add({.dt = 0.010, .position = {0.1, 0.0, 0.0}, .force = {0.0, 1.0, 0.0}});
    std::vector<SoundFrame> frames(480);
    room.player.fill(frames); // it is the newest tick that the player knows of
    room.pass(0.5);
    EXPECT_EQ(room.player.figures().leftOut, 0u);
    // As long as what waits is counted: ten such are as much as a hundred of 1 ms.
    for (int i = 0; i < 10; ++i)
        room.feed.add({.dt = 0.010, .position = {0.1, 0.0, 0.0}, .force = {0.0, 1.0, 0.0}});
    room.pass(0.5);
    EXPECT_EQ(room.player.figures().leftOut, 1u);
}

TEST(LiveSound, IsNeverLouderThanTheVolume) {
    Room room;
    room.player.setVolume(0.25f);
    room.pass(1.0, true, 100.0);
    EXPECT_LE(loudest(room.heard), 0.25);
    EXPECT_GT(loudest(room.heard), 0.2);
    room.player.setVolume(0.0f);
    room.pass(0.3, true, 100.0);
    EXPECT_LT(loudest(room.last(0.1)), 1e-4);
}

TEST(LiveSound, IsSilentForAMomentWhenTheWorldIsSwapped) {
    Room room;
    room.pass(1.0);
    const double tone = largestStep(room.last(0.5));
    room.player.interrupt();
    room.pass(0.05);
    EXPECT_EQ(loudest(room.last(0.02)), 0.0);
    room.pass(0.5);
    EXPECT_GT(loudest(room.last(0.1)), 0.3);
    EXPECT_LT(largestStep(room.heard), tone + 1.0 / (SoundPlayer::kFade * kRate) + 1e-3);
}

TEST(LiveSound, NobodyListeningCostsNoRoom) {
    Room room;
    room.feed.listen(false);
    room.pass(3.0);
    EXPECT_EQ(loudest(room.heard), 0.0);
    SoundTick tick;
    EXPECT_FALSE(room.feed.pop(tick));
}

TEST(LiveSound, NeitherTheServoNorTheCardAllocates) {
    SoundFeed feed;
    SoundPlayer player(feed, kRate);
    feed.listen(true);
    player.setVolume(1.0f);
    std::vector<SoundFrame> frames(480);
    const uint64_t before = allocationsOnThisThread();
    for (int i = 0; i < 3000; ++i) {
        feed.add({.force = {0.0, std::sin(0.6 * i), 0.0}});
        if (i % 10 == 9)
            player.fill(frames);
    }
    EXPECT_EQ(allocationsOnThisThread(), before);
    EXPECT_GT(player.figures().peak, 0.1f);
}

} // namespace
} // namespace touchstone::test::live_sound_test
