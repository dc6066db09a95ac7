// The sound card that is not there. Each test runs in a process of its own (ctest), where ALSA reads a
// configuration that names no card, so that nothing is heard on a machine that has one.

#include "sound/masking_noise.h"
#include "sound/sound_card.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

namespace touchstone::test::sound_card_test {
namespace {

class SoundCardTest : public testing::Test {
  protected:
    SoundCardTest() {
        configure("# no card\n");
        setenv("JACK_NO_START_SERVER", "1", 1);
        setenv("JACK_DEFAULT_SERVER", "touchstone-has-none", 1);
    }

    /// What ALSA knows of, in place of the system's.
    void configure(const std::string& text) {
        const auto config = scratch_ / "asound.conf";
        std::ofstream(config) << text;
        setenv("ALSA_CONFIG_PATH", config.c_str(), 1);
    }

    SoundCard::State awaitState(SoundCard& card, bool on) {
        for (int i = 0; i < 1000; ++i) {
            card.update(on, 0.5f);
            if (on && (card.state() == SoundCard::State::Failed || card.state() == SoundCard::State::Playing))
                break;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return card.state();
    }

    ScratchFolder scratch_;
    SoundFeed feed_;
};

TEST_F(SoundCardTest, SaysThatThereIsNoneAndNothingElse) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    {
        SoundCard card(feed_);
        card.update(false, 0.5f);
        EXPECT_EQ(card.state(), SoundCard::State::Off);
        EXPECT_EQ(awaitState(card, true), SoundCard::State::Failed);
        EXPECT_NE(card.problem().find("there is no sound card"), std::string::npos) << card.problem();
        EXPECT_NE(card.problem().find("remedy"), std::string::npos) << card.problem();
        EXPECT_FALSE(feed_.heard()) << "the servo need not fill a ring that nobody reads";
        card.interrupt();
        EXPECT_EQ(card.figures().latency, 0.0);
        // Off and on again looks once more.
        card.update(false, 0.5f);
        EXPECT_EQ(card.state(), SoundCard::State::Off);
        EXPECT_EQ(awaitState(card, true), SoundCard::State::Failed);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST_F(SoundCardTest, PlaysOnWhatTheSystemCallsItsDefault) {
    configure("pcm.!default { type null }\n"); // a card that swallows all
    SoundCard card(feed_);
    ASSERT_EQ(awaitState(card, true), SoundCard::State::Playing) << card.problem();
    EXPECT_EQ(card.name(), "default");
    EXPECT_TRUE(feed_.heard());
    // It swallows faster than any clock: what was played is known by its having come to an end.
    for (int i = 0; i < 5000 && card.figures().runsDry == 0; ++i) {
        feed_.add({.force = {0.0, i % 10 < 5 ? 1.0 : 0.0, 0.0}});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        card.update(true, 0.5f);
    }
    EXPECT_GT(card.figures().runsDry, 0u);
    EXPECT_GT(card.figures().latency, 0.0);
    card.update(false, 0.5f);
    EXPECT_EQ(card.state(), SoundCard::State::Off);
}

TEST_F(SoundCardTest, PlaysAnotherSourceThanTheForce) {
    const auto file = scratch_ / "played.raw";
    configure("pcm.!default { type file slave.pcm { type null } file \"" + file.string() +
              "\" format raw }\n");
    NoiseControl noise;
    {
        SoundCard card([&noise](double rate) { return std::make_unique<MaskingNoise>(noise, rate); });
        ASSERT_EQ(awaitState(card, true), SoundCard::State::Playing) << card.problem();
        EXPECT_EQ(card.figures().runsDry, 0u) << "of the force alone";
        noise.cue();
        // What was played before the volume was known is silent; the card takes frames faster than any clock.
        const auto size = [&] {
            return std::filesystem::exists(file) ? std::filesystem::file_size(file) : 0;
        };
        const auto before = size();
        for (int i = 0; i < 1000 && size() < before + 1'000'000; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        card.interrupt(); // of the force: nothing happens
    }
    std::string played = test::readFile(file);
    played.resize(played.size() / sizeof(float) * sizeof(float));
    float most = 0.0f;
    for (size_t i = 0; i < played.size(); i += sizeof(float)) {
        float value = 0.0f;
        std::memcpy(&value, played.data() + i, sizeof value);
        most = std::max(most, std::abs(value));
    }
    EXPECT_GT(most, 0.2f) << "a volume of 0.5";
    EXPECT_LE(most, 0.5f);
}

TEST_F(SoundCardTest, SaysThatTheCardIsGone) {
    // A card that takes nothing from some moment on: its frames go to a disk that is full.
    configure("pcm.!default { type file slave.pcm { type null } file \"/dev/full\" format raw }\n");
    testing::internal::CaptureStderr();
    SoundCard card(feed_);
    SoundCard::State state = awaitState(card, true);
    for (int i = 0; i < 1000 && state == SoundCard::State::Playing; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        card.update(true, 0.5f);
        state = card.state();
    }
    EXPECT_EQ(state, SoundCard::State::Failed);
    EXPECT_NE(card.problem().find("the sound card is gone"), std::string::npos) << card.problem();
    EXPECT_EQ(card.figures().latency, 0.0);
    for (int i = 0; i < 1000 && feed_.heard(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_FALSE(feed_.heard());
    (void)testing::internal::GetCapturedStderr(); // PortAudio tells it where we cannot hush it
    card.update(false, 0.5f);
    EXPECT_EQ(card.state(), SoundCard::State::Off);
}

TEST_F(SoundCardTest, MayEndWhileItIsOpened) {
    SoundCard card(feed_);
    card.update(true, 0.5f);
    EXPECT_EQ(card.state(), SoundCard::State::Opening);
}

} // namespace
} // namespace touchstone::test::sound_card_test
