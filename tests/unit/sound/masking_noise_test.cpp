#include "sound/masking_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchstone::masking_noise_test {
namespace {

constexpr double kRate = 48000.0;

std::vector<double> played(MaskingNoise& noise, size_t count) {
    std::vector<SoundFrame> frames(count);
    noise.fill(frames);
    std::vector<double> values(count);
    std::ranges::transform(frames, values.begin(), [](const SoundFrame& f) { return f.left; });
    return values;
}

double correlation(const std::vector<double>& x, size_t lag) {
    double product = 0.0, square = 0.0;
    for (size_t i = 0; i + lag < x.size(); ++i) {
        product += x[i] * x[i + lag];
        square += x[i] * x[i];
    }
    return product / square;
}

/// Share of the power at a frequency, of `x` (Goertzel).
double powerAt(const std::vector<double>& x, double hz) {
    double re = 0.0, im = 0.0;
    for (size_t i = 0; i < x.size(); ++i) {
        const double phase = 2.0 * M_PI * hz * static_cast<double>(i) / kRate;
        re += x[i] * std::cos(phase);
        im += x[i] * std::sin(phase);
    }
    return (re * re + im * im) / static_cast<double>(x.size());
}

TEST(MaskingNoise, IsWhiteAndKeepsItsVolume) {
    NoiseControl control;
    MaskingNoise noise(control, kRate);
    for (const double v : played(noise, 1000))
        ASSERT_EQ(v, 0.0) << "silent before it has a volume";
    noise.setVolume(0.4f);
    (void)played(noise, 48000);
    const std::vector<double> x = played(noise, 96000);
    double mean = 0.0, most = 0.0;
    for (const double v : x) {
        mean += v / static_cast<double>(x.size());
        most = std::max(most, std::abs(v));
    }
    EXPECT_NEAR(mean, 0.0, 2e-3);
    EXPECT_LE(most, 0.4);
    EXPECT_GT(most, 0.19);
    for (const size_t lag : {1u, 2u, 7u, 48u, 480u}) // 5 standard deviations of white noise
        EXPECT_NEAR(correlation(x, lag), 0.0, 5.0 / std::sqrt(96000.0)) << lag;
}

TEST(MaskingNoise, ACueIsATone) {
    NoiseControl control;
    MaskingNoise noise(control, kRate);
    noise.setVolume(1.0f);
    (void)played(noise, 48000);
    const auto length = static_cast<size_t>(MaskingNoise::kCueSeconds * kRate);
    const double without = powerAt(played(noise, length), MaskingNoise::kCueHz);
    control.cue();
    const std::vector<double> cue = played(noise, length);
    EXPECT_GT(powerAt(cue, MaskingNoise::kCueHz), 100.0 * without);
    for (const double v : cue)
        ASSERT_LE(std::abs(v), 1.0);
    (void)played(noise, 100);
    EXPECT_LT(powerAt(played(noise, length), MaskingNoise::kCueHz), 10.0) << "and ends";
}

} // namespace
} // namespace touchstone::masking_noise_test
