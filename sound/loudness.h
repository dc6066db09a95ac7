#pragma once

#include <cstddef>
#include <vector>

namespace touchstone {

/// Left and right, 1: full scale.
struct SoundFrame {
    float left = 0.0f, right = 0.0f;
};

/// Logarithmic compression from N/s to loudness: a tap and faint texture differ by three decades. The gain
/// follows the envelope and not the wave, so a tone stays a tone. The envelope is never below its wave (it is
/// known kLookAhead before), so |out| <= 1 without clipping. Any one thread; no allocation after
/// construction.
class Loudness {
  public:
    static constexpr float kFaintest = 1.0f;    ///< N/s: well below it loudness is proportional
    static constexpr float kLoudest = 1000.0f;  ///< N/s: full scale from here on
    static constexpr double kLookAhead = 0.004; ///< s, delay of the output
    static constexpr double kHold =
        0.026; ///< s: with kLookAhead half a wave of 17 Hz, so that no tone is modulated
    static constexpr double kRelease = 0.15; ///< s, to 1/e

    /// `rate`: frames per second.
    explicit Loudness(double rate);

    /// Takes a frame in N/s, returns the one kLookAhead earlier.
    [[nodiscard]] SoundFrame add(const SoundFrame& frame) noexcept;
    void reset() noexcept;

    /// Loudness of an envelope in N/s as a fraction of full scale, 0..1.
    [[nodiscard]] static float loudnessOf(float envelope) noexcept;

  private:
    /// Maximum of the last `window` values, by a monotone queue.
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
