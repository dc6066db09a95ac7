#pragma once

#include <cstddef>
#include <vector>

namespace touchstone {

/// Left and right, 1: full scale.
struct SoundFrame {
    float left = 0.0f, right = 0.0f;
};

/// From N/s to loudness, by its logarithm, as ears have it: from a tap to a whisper of texture there are
/// three decades. The gain follows the envelope and not the wave, so a tone stays a tone. The envelope is
/// never below the wave that it is for (it is known kLookAhead before), so |out| <= 1 without clipping. Any
/// one thread; no allocation after construction.
class Loudness {
  public:
    static constexpr float kFaintest = 1.0f;    ///< N/s: well below it loudness goes to zero in proportion
    static constexpr float kLoudest = 1000.0f;  ///< N/s: from here on it is full
    static constexpr double kLookAhead = 0.004; ///< s, the delay of all that is heard
    static constexpr double kHold =
        0.026; ///< s: with kLookAhead half a wave of 17 Hz, so that no tone is modulated
    static constexpr double kRelease = 0.15; ///< s, to 1/e

    /// `rate`: frames a second.
    explicit Loudness(double rate);

    /// Takes a frame in N/s, gives the one of kLookAhead ago.
    [[nodiscard]] SoundFrame add(const SoundFrame& frame) noexcept;
    void reset() noexcept;

    /// What an envelope in N/s is as a share of full scale, 0..1.
    [[nodiscard]] static float loudnessOf(float envelope) noexcept;

  private:
    /// The largest of the last `window` values: candidates in falling order (a monotone queue).
    class SlidingMaximum {
      public:
        explicit SlidingMaximum(size_t window) : slots_(window + 1), window_(window) {}
        float add(float value) noexcept;
        void reset() noexcept { first_ = count_ = 0; }

      private:
        struct Slot {
            float value = 0.0f;
            size_t time = 0;
        };
        std::vector<Slot> slots_;
        size_t window_, first_ = 0, count_ = 0, now_ = 0;
    };

    size_t delay_; // frames
    float release_;
    SlidingMaximum peak_;
    std::vector<SoundFrame> waiting_; // delay_ + 1 frames
    std::vector<float> peaks_;        // of the same frames
    size_t next_ = 0;
    float held_ = 0.0f;
    double sum_ = 0.0; // of peaks_
};

} // namespace touchstone
