#pragma once
// White noise that masks what a device can be heard doing, and tones that mark the transition between stimuli
// [004 §5].

#include "sound/sound_source.h"

#include <atomic>
#include <cstdint>

namespace touchstone {

/// The owner's end; outlives the noise. Any thread.
class NoiseControl {
  public:
    /// A tone of kCueSeconds, one after the other.
    void cue() noexcept { cues_.fetch_add(1, std::memory_order_relaxed); }
    [[nodiscard]] uint32_t cues() const noexcept { return cues_.load(std::memory_order_relaxed); }

  private:
    std::atomic<uint32_t> cues_{0};
};

/// White noise, uniform in amplitude, the same in both channels; a cue is a tone over it. One thread renders.
class MaskingNoise final : public SoundSource {
  public:
    static constexpr float kNoise = 0.5f, kTone = 0.5f; ///< of the volume
    static constexpr double kCueHz = 880.0, kCueSeconds = 0.15, kFade = 0.01;

    /// `rate`: frames per second.
    MaskingNoise(NoiseControl& control, double rate) noexcept
        : control_(control), rate_(rate), seen_(control.cues()) {}

    void fill(std::span<SoundFrame> frames) noexcept override;
    void setVolume(float volume) noexcept override { volume_.store(volume, std::memory_order_relaxed); }

  private:
    [[nodiscard]] float white() noexcept;
    [[nodiscard]] float tone() noexcept;

    NoiseControl& control_;
    double rate_;
    std::atomic<float> volume_{0.0f};
    // The card's thread:
    float loud_ = 0.0f; // follows the volume
    uint64_t random_ = 0x853c49e6748fea9bu;
    uint32_t seen_ = 0;
    double cue_ = -1.0; // s since the tone began; negative: none
};

} // namespace touchstone
