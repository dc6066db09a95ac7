#include "tests/unit/sound/tone.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace touchstone::test {

double toneIn(std::span<const float> channel, double rate, double frequency) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const auto count = static_cast<double>(channel.size());
    std::complex<double> sum = 0.0;
    // Both turn by the same angle from frame to frame; rounding of 1e-16 a turn stays far below a tone.
    const std::complex<double> turn = std::polar(1.0, -kTurn * frequency / rate),
                               windowTurn = std::polar(1.0, kTurn / count);
    std::complex<double> wave = 1.0, window = 1.0;
    for (const float value : channel) {
        sum += (1.0 - window.real()) * static_cast<double>(value) * wave; // Hann, of mean 1
        wave *= turn;
        window *= windowTurn;
    }
    return 2.0 * std::abs(sum) / count;
}

double strongestTone(std::span<const float> channel, double rate, double least, double most, double step) {
    double best = least, strength = -1.0;
    for (double frequency = least; frequency <= most; frequency += step) {
        const double found = toneIn(channel, rate, frequency);
        if (found > strength) {
            strength = found;
            best = frequency;
        }
    }
    return best;
}

std::vector<float> leftOf(std::span<const SoundFrame> frames) {
    std::vector<float> channel(frames.size());
    std::ranges::transform(frames, channel.begin(), &SoundFrame::left);
    return channel;
}

std::vector<float> rightOf(std::span<const SoundFrame> frames) {
    std::vector<float> channel(frames.size());
    std::ranges::transform(frames, channel.begin(), &SoundFrame::right);
    return channel;
}

double loudest(std::span<const SoundFrame> frames) {
    float most = 0.0f;
    for (const SoundFrame& frame : frames)
        most = std::max({most, std::abs(frame.left), std::abs(frame.right)});
    return static_cast<double>(most);
}

} // namespace touchstone::test
