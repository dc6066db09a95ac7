#include "sound/loudness.h"
#include "tests/unit/sound/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace touchstone::test::loudness_test {
namespace {

constexpr double kRate = 48000.0, kTurn = 2.0 * std::numbers::pi;

std::vector<SoundFrame> toneThrough(Loudness& loudness, double amplitude, double frequency, double seconds) {
    std::vector<SoundFrame> out;
    for (int i = 0; i < static_cast<int>(seconds * kRate); ++i) {
        const auto now = static_cast<float>(amplitude * std::sin(kTurn * frequency * i / kRate));
        out.push_back(loudness.add({now, 0.0f}));
    }
    return out;
}

TEST(Loudness, EachFactorInTheForceIsTheSameStepInLoudness) {
    const auto of = [](double envelope) {
        return static_cast<double>(Loudness::loudnessOf(static_cast<float>(envelope)));
    };
    const double octave = of(200.0) - of(100.0);
    EXPECT_NEAR(of(400.0) - of(200.0), octave, 0.01 * octave);
    EXPECT_NEAR(of(800.0) - of(400.0), octave, 0.01 * octave);
    EXPECT_EQ(of(0.0), 0.0);
    EXPECT_EQ(of(Loudness::kLoudest), 1.0);
    EXPECT_EQ(of(1e9), 1.0);
}

TEST(Loudness, AToneStaysATone) {
    for (const double frequency : {25.0, 100.0, 440.0})
        for (const double amplitude : {2.0, 100.0, 5000.0}) {
            Loudness loudness(kRate);
            auto frames = toneThrough(loudness, amplitude, frequency, 1.5);
            frames.erase(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(kRate / 2));
            const std::vector<float> left = leftOf(frames);
            const double expected = static_cast<double>(Loudness::loudnessOf(static_cast<float>(amplitude)));
            EXPECT_NEAR(toneIn(left, kRate, frequency), expected, 1e-3 * expected);
            for (const double harmonic : {2.0, 3.0, 5.0})
                EXPECT_LT(toneIn(left, kRate, harmonic * frequency), 1e-3 * expected);
        }
}

TEST(Loudness, IsNeverAboveWhatItsEnvelopeSays) {
    Loudness loudness(kRate);
    // From silence into the middle of the loudest: nothing jumps over, and nothing is cut off flat.
    (void)toneThrough(loudness, 0.0, 100.0, 0.2);
    const auto frames = toneThrough(loudness, 2e4, 300.0, 0.3);
    EXPECT_LE(loudest(frames), 1.0);
    EXPECT_GT(loudest(frames), 0.99);
    size_t flat = 0;
    for (size_t i = 0; i + 1 < frames.size(); ++i)
        flat += std::abs(frames[i].left) > 0.999f && frames[i].left == frames[i + 1].left;
    EXPECT_LT(flat, 200u);
}

TEST(Loudness, IsAsMuchLaterAsItLooksAhead) {
    Loudness loudness(kRate);
    const auto delay = static_cast<int>(Loudness::kLookAhead * kRate);
    for (int i = 0; i < 2 * delay; ++i) {
        const SoundFrame out = loudness.add({i == 0 ? 100.0f : 0.0f, 0.0f});
        EXPECT_EQ(out.left > 0.0f, i == delay) << i;
    }
}

TEST(Loudness, AWhisperAfterATapIsHeardAgainWithinASecond) {
    Loudness loudness(kRate);
    (void)toneThrough(loudness, 1000.0, 200.0, 0.1);
    auto frames = toneThrough(loudness, 5.0, 200.0, 2.0);
    const std::vector<float> left = leftOf(frames);
    const std::span late = std::span(left).subspan(static_cast<size_t>(kRate));
    const double alone = static_cast<double>(Loudness::loudnessOf(5.0f));
    EXPECT_NEAR(toneIn(late, kRate, 200.0), alone, 0.01 * alone);
}

} // namespace
} // namespace touchstone::test::loudness_test
