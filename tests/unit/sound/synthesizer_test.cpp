// The sound of forces of which it is known in closed form.

#include "sound/synthesizer.h"
#include "tests/support/allocation_counter.h"
#include "tests/unit/sound/tone.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace touchstone::test::synthesizer_test {
namespace {

constexpr double kRate = 48000.0, kTurn = 2.0 * std::numbers::pi;
constexpr double kPress = 0.9238795, kAside = 0.3826834; // what a part is in its own ear and in the other

/// What is heard of `seconds` of a touch, `tickAt` of each time.
std::vector<SoundFrame> heard(double seconds, double tickRate,
                              const std::function<SoundTick(double)>& tickAt) {
    Synthesizer synthesizer(kRate);
    std::vector<SoundFrame> all, block(4096);
    const auto ticks = static_cast<size_t>(seconds * tickRate);
    for (size_t i = 0; i < ticks; ++i) {
        SoundTick tick = tickAt(static_cast<double>(i) / tickRate);
        tick.dt = 1.0 / tickRate;
        EXPECT_TRUE(synthesizer.push(tick));
        const size_t made = synthesizer.render(block);
        all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(made));
    }
    return all;
}

/// Pressed with a mean of 1 N along y while the hand strokes along x at `speed`, m/s.
SoundTick stroke(double t, double speed, double press, double drag) {
    return {.position = {speed * t, 0.0, 0.0}, .force = {drag, 1.0 + press, 0.0}};
}

std::vector<SoundFrame> steady(std::vector<SoundFrame> frames) { // without the first half second
    frames.erase(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(kRate / 2));
    return frames;
}

/// What the envelope of a tone in the force, `amplitude` in N, is: by the difference of two ticks.
double rateOf(double amplitude, double frequency, double tickRate) {
    const double highPass = 1.0 / std::sqrt(1.0 + std::pow(ForceChange::kLowest / frequency, 4.0));
    return amplitude * highPass * 2.0 * tickRate * std::sin(std::numbers::pi * frequency / tickRate);
}

TEST(Synthesizer, ASineReliefSoundsAsSpeedOverWavelength) {
    constexpr double kWavelength = 1e-3; // m
    for (const double tickRate : {500.0, 1000.0, 4000.0})
        for (const double speed : {0.05, 0.1, 0.2}) {
            const double tone = speed / kWavelength;
            const auto frames = steady(heard(2.0, tickRate, [&](double t) {
                return stroke(t, speed, 0.0, 0.05 * std::sin(kTurn * tone * t));
            }));
            const std::vector<float> right = rightOf(frames);
            EXPECT_EQ(strongestTone(right, kRate, 25.0, 1000.0), tone) << tickRate << " Hz, " << speed;
            const double found = toneIn(right, kRate, tone);
            // The hand's speed beyond that at which half of the dragging is heard.
            const double share = speed / (speed + ForceChange::kSlow);
            const double envelope = share * rateOf(0.05, tone, tickRate) * kPress;
            const double expected = static_cast<double>(Loudness::loudnessOf(static_cast<float>(envelope)));
            EXPECT_NEAR(found, expected, 0.03 * expected) << tickRate << " Hz, " << speed;
            for (const double harmonic : {2.0, 3.0})
                EXPECT_LT(toneIn(right, kRate, harmonic * tone), 0.02 * found) << harmonic << " of " << tone;
            // Dragging is in the left ear, too, as the other part of it.
            EXPECT_NEAR(toneIn(leftOf(frames), kRate, tone), found * kAside / kPress, 0.02 * found);
        }
}

TEST(Synthesizer, NoImageOfAToneIsAdded) {
    for (const double tone : {60.0, 200.0, 350.0}) {
        const auto left = leftOf(steady(heard(
            2.0, 1000.0, [&](double t) { return stroke(t, 0.0, 0.1 * std::sin(kTurn * tone * t), 0.0); })));
        const double found = toneIn(left, kRate, tone);
        EXPECT_GT(found, 0.1);
        for (const double image : {1000.0 - tone, 1000.0 + tone, 2000.0 - tone, 2000.0 + tone})
            EXPECT_LT(toneIn(left, kRate, image), 0.002 * found) << image << " Hz beside " << tone;
    }
}

TEST(Synthesizer, PressingAndDraggingNeverCancelInBothEars) {
    for (int k = 0; k < 8; ++k) {
        const double phase = k * kTurn / 8.0;
        const auto frames = steady(heard(2.0, 1000.0, [&](double t) {
            return stroke(t, 0.1, 0.05 * std::sin(kTurn * 100.0 * t),
                          0.05 * std::sin(kTurn * 100.0 * t + phase));
        }));
        EXPECT_GT(std::max(toneIn(leftOf(frames), kRate, 100.0), toneIn(rightOf(frames), kRate, 100.0)), 0.3)
            << phase;
    }
}

TEST(Synthesizer, NoForceIsNoSoundToTheLastBit) {
    const auto frames = heard(1.0, 1000.0, [](double t) {
        return SoundTick{.position = {0.1 * std::sin(20.0 * t), 0.0, 0.0}};
    });
    EXPECT_GT(frames.size(), 40000u);
    EXPECT_EQ(loudest(frames), 0.0);
}

TEST(Synthesizer, AForceThatWasThereAndStaysIsNoSound) {
    EXPECT_EQ(loudest(heard(1.0, 1000.0, [](double t) { return stroke(t, 0.1, 2.0, 0.5); })), 0.0);
}

TEST(Synthesizer, WhatTheHandDoesSlowlyIsFarBelowATexture) {
    // 1 N more and less twice a second, against 20 mN of a texture of 150 Hz.
    const auto pressing = steady(
        heard(2.0, 1000.0, [](double t) { return stroke(t, 0.1, 1.0 + std::sin(kTurn * 2.0 * t), 0.0); }));
    const auto texture = steady(
        heard(2.0, 1000.0, [](double t) { return stroke(t, 0.1, 0.0, 0.02 * std::sin(kTurn * 150.0 * t)); }));
    EXPECT_GT(loudest(texture), 0.2);
    EXPECT_LT(loudest(pressing), 0.12 * loudest(texture));
}

TEST(Synthesizer, TheEndOfContactIsSilentAfterATenthOfASecond) {
    const auto frames = heard(2.0, 1000.0, [](double t) {
        return t < 1.0 ? stroke(t, 0.1, 0.0, 0.1 * std::sin(kTurn * 100.0 * t))
                       : SoundTick{.position = {0.1 * t, 0.0, 0.0}};
    });
    const auto after = static_cast<size_t>(1.15 * kRate);
    EXPECT_LT(loudest(std::span(frames).subspan(after)), 1e-4);
}

/// The largest step from one frame to the next, against that of the tone that is there.
TEST(Synthesizer, AContactThatBeginsGentlyDoesNotClick) {
    const auto force = [](double t) { // pressed and let go within 0.2 s, as smooth as a cosine
        const double in = std::clamp((t - 0.5) / 0.2, 0.0, 1.0), out = std::clamp((t - 1.3) / 0.2, 0.0, 1.0);
        return 0.5 - 0.5 * std::cos(kTurn / 2.0 * (in - out));
    };
    const auto frames = heard(2.0, 1000.0, [&](double t) {
        const double pressed = force(t);
        return SoundTick{.position = {0.1 * t, 0.0, 0.0},
                         .force = {0.05 * pressed * std::sin(kTurn * 100.0 * t), pressed, 0.0}};
    });
    const auto largestStep = [&](double from, double to) {
        double most = 0.0;
        for (auto i = static_cast<size_t>(from * kRate); i < static_cast<size_t>(to * kRate); ++i)
            most = std::max(most, std::abs(static_cast<double>(frames[i + 1].right - frames[i].right)));
        return most;
    };
    const double tone = largestStep(0.9, 1.1);
    EXPECT_GT(tone, 0.003);
    EXPECT_LT(largestStep(0.4, 0.8), 1.05 * tone);
    EXPECT_LT(largestStep(1.2, 1.7), 1.05 * tone);
}

TEST(Synthesizer, NothingIsLouderThanFullScale) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> anything(-1.0, 1.0), decades(-6.0, 6.0);
    Synthesizer synthesizer(kRate);
    std::vector<SoundFrame> block(256);
    double most = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const double size = i % 50 < 25 ? std::pow(10.0, decades(random)) : 8.5;
        (void)synthesizer.push(
            {.dt = i % 7 == 0 ? 3e-3 : 1e-3,
             .position = {anything(random), anything(random), anything(random)},
             .force = size * glm::dvec3(anything(random), anything(random), anything(random)),
             .handKnown = i % 31 != 0});
        most = std::max(most, loudest(std::span(block).first(synthesizer.render(block))));
    }
    EXPECT_LE(most, 1.0);
    EXPECT_GT(most, 0.8);
}

TEST(Synthesizer, TicksOfOtherLengthsChangeNoTone) {
    // Every tenth tick was slept through.
    Synthesizer synthesizer(kRate);
    std::vector<SoundFrame> all, block(4096);
    for (int i = 0; i < 3000; ++i) {
        if (i % 10 == 9)
            continue;
        const double t = 1e-3 * i;
        SoundTick tick = stroke(t, 0.1, 0.1 * std::sin(kTurn * 40.0 * t), 0.0);
        tick.dt = i % 10 == 0 && i > 0 ? 2e-3 : 1e-3;
        ASSERT_TRUE(synthesizer.push(tick));
        const size_t made = synthesizer.render(block);
        all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(made));
    }
    EXPECT_NEAR(static_cast<double>(all.size()), 3.0 * kRate, 0.02 * kRate) << "no time is lost";
    EXPECT_EQ(strongestTone(leftOf(steady(all)), kRate, 25.0, 95.0), 40.0);
}

TEST(Synthesizer, NeitherPushingNorRenderingAllocates) {
    Synthesizer synthesizer(kRate);
    std::vector<SoundFrame> block(4096);
    const uint64_t before = allocationsOnThisThread();
    for (int i = 0; i < 2000; ++i) {
        (void)synthesizer.push(stroke(1e-3 * i, 0.1, 0.0, std::sin(0.6 * i)));
        (void)synthesizer.render(block);
    }
    synthesizer.reset();
    EXPECT_EQ(allocationsOnThisThread(), before);
}

TEST(Synthesizer, AResetForgetsWhatWasFelt) {
    Synthesizer used(kRate), fresh(kRate);
    std::vector<SoundFrame> one(48), other(48);
    for (int i = 0; i < 300; ++i)
        (void)used.push(stroke(1e-3 * i, 0.1, std::sin(0.6 * i), 0.0));
    used.reset();
    for (int i = 0; i < 500; ++i) {
        const SoundTick tick = stroke(1e-3 * i, 0.1, std::sin(0.3 * i), 0.2);
        (void)used.push(tick);
        (void)fresh.push(tick);
        ASSERT_EQ(used.render(one), fresh.render(other));
        for (size_t k = 0; k < one.size(); ++k)
            ASSERT_EQ(one[k].left, other[k].left) << i;
    }
}

} // namespace
} // namespace touchstone::test::synthesizer_test
