#pragma once

#include "sound/loudness.h"

#include <functional>
#include <span>
#include <vector>

namespace touchstone::test {

/// Amplitude of the tone of `frequency` in a channel (Hann window), full scale 1.
[[nodiscard]] double toneIn(std::span<const float> channel, double rate, double frequency);
/// The strongest of the frequencies from `least` to `most` in steps of `step`, Hz.
[[nodiscard]] double strongestTone(std::span<const float> channel, double rate, double least, double most,
                                   double step = 1.0);
[[nodiscard]] std::vector<float> leftOf(std::span<const SoundFrame> frames);
[[nodiscard]] std::vector<float> rightOf(std::span<const SoundFrame> frames);
/// The largest magnitude in both channels.
[[nodiscard]] double loudest(std::span<const SoundFrame> frames);

} // namespace touchstone::test
