#include "sound/masking_noise.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

/// xorshift64*, its upper 24 bits: -1..1.
float MaskingNoise::white() noexcept {
    random_ ^= random_ >> 12;
    random_ ^= random_ << 25;
    random_ ^= random_ >> 27;
    const auto bits = static_cast<uint32_t>((random_ * 0x2545f4914f6cdd1du) >> 40);
    return static_cast<float>(bits) * (2.0f / 16777215.0f) - 1.0f;
}

float MaskingNoise::tone() noexcept {
    if (cue_ < 0.0)
        return 0.0f;
    const double edge = std::clamp(std::min(cue_, kCueSeconds - cue_) / kFade, 0.0, 1.0);
    const double value = edge * std::sin(6.283185307179586 * kCueHz * cue_);
    cue_ += 1.0 / rate_;
    if (cue_ >= kCueSeconds)
        cue_ = -1.0;
    return static_cast<float>(value);
}

void MaskingNoise::fill(std::span<SoundFrame> frames) noexcept {
    const float volume = volume_.load(std::memory_order_relaxed);
    const auto share = static_cast<float>(-std::expm1(-1.0 / (0.01 * rate_))); // 10 ms to another volume
    for (SoundFrame& frame : frames) {
        if (cue_ < 0.0 && seen_ != control_.cues()) {
            ++seen_;
            cue_ = 0.0;
        }
        loud_ += share * (volume - loud_);
        const float value = std::clamp(kNoise * white() + kTone * tone(), -1.0f, 1.0f);
        frame.left = frame.right = loud_ * value;
    }
}

} // namespace touchstone
