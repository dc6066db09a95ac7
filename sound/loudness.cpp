#include "sound/loudness.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

float Loudness::SlidingMaximum::add(float value) noexcept {
    const auto slot = [this](size_t i) -> Slot& { return slots_[(first_ + i) % slots_.size()]; };
    while (count_ > 0 && slot(count_ - 1).value <= value)
        --count_;
    slot(count_++) = {value, now_};
    if (now_ - slot(0).time >= window_) {
        first_ = (first_ + 1) % slots_.size();
        --count_;
    }
    ++now_;
    return slot(0).value;
}

Loudness::Loudness(double rate)
    : delay_(static_cast<size_t>(std::ceil(kLookAhead * rate))),
      release_(static_cast<float>(std::exp(-1.0 / (kRelease * rate)))),
      peak_(delay_ + 1 + static_cast<size_t>(kHold * rate)), waiting_(delay_ + 1), peaks_(delay_ + 1) {}

float Loudness::loudnessOf(float envelope) noexcept {
    static const float kWhole = std::log1p(kLoudest / kFaintest);
    return std::min(1.0f, std::log1p(envelope / kFaintest) / kWhole);
}

/// The envelope is the mean of the last delay_ + 1 peaks, each over a window that contains the current output
/// frame: so it is not below that frame.
SoundFrame Loudness::add(const SoundFrame& frame) noexcept {
    const float now = std::max(std::abs(frame.left), std::abs(frame.right));
    held_ = std::max(peak_.add(now), held_ * release_);
    sum_ += static_cast<double>(held_) - static_cast<double>(peaks_[next_]);
    peaks_[next_] = held_;
    waiting_[next_] = frame;
    next_ = (next_ + 1) % waiting_.size();
    const SoundFrame out = waiting_[next_];

    const float envelope = std::max({static_cast<float>(sum_ / static_cast<double>(peaks_.size())),
                                     std::abs(out.left), std::abs(out.right)}); // rounding of the sum
    constexpr float kNothing = 1e-6f;                                           // N/s
    if (envelope < kNothing)
        return {};
    const float gain = loudnessOf(envelope) / envelope;
    return {gain * out.left, gain * out.right};
}

void Loudness::reset() noexcept {
    peak_.reset();
    std::ranges::fill(waiting_, SoundFrame{});
    std::ranges::fill(peaks_, 0.0f);
    held_ = 0.0f;
    sum_ = 0.0;
}

} // namespace touchstone
