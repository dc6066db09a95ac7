#pragma once
// Band-limited resampling from ticks to the frames of a sound card.

#include "sound/force_change.h"

#include <array>
#include <cstddef>

namespace touchstone {

/// Two channels, press and drag, N/s.
struct StretchedFrame {
    float press = 0.0f, drag = 0.0f;
};

/// Interpolates between ticks by a sinc of 16 taps under a Kaiser window (beta 6), with a cutoff at half of
/// the tick rate: it preserves the signal of the ticks without images (docs/sound.md gives the accuracy). Not
/// libsamplerate, whose fastest sinc has a delay of 19 ticks (this one 8) and which does not support ticks of
/// varying length. Any one thread; no allocation.
class TickStretcher {
  public:
    static constexpr size_t kReach = 8;       ///< ticks on either side of a frame
    static constexpr size_t kCapacity = 4096; ///< ticks, a power of two

    /// `rate`: frames per second.
    explicit TickStretcher(double rate);

    /// False, without effect, when kCapacity ticks are queued.
    bool push(const ForceRates& rates, double dt) noexcept;
    /// The next frame; `speed` 1.01 plays ticks 1 % shorter. False if it needs ticks that have not arrived.
    bool pop(StretchedFrame& frame, double speed = 1.0) noexcept;
    /// Frames playable with the queued ticks, at speed 1. Time grows with their number.
    [[nodiscard]] double ahead() const noexcept;
    /// Skips up to `frames`, by whole ticks, as far as available.
    void skip(double frames) noexcept;
    void reset() noexcept;

  private:
    static constexpr size_t kTaps = 2 * kReach, kPhases = 256;
    struct Tick {
        float press = 0.0f, drag = 0.0f;
        float frames = 1.0f; // duration
    };
    [[nodiscard]] const Tick& at(size_t index) const noexcept { return ticks_[index & (kCapacity - 1)]; }

    double rate_;
    std::array<std::array<float, kTaps>, kPhases + 1> kernel_;
    std::array<Tick, kCapacity> ticks_{};
    size_t end_ = kReach;       // index of the next tick; those before the first are silent
    size_t begin_ = kReach - 1; // the frame lies between this tick and the next
    double phase_ = 0.0;        // 0..1 between the two
};

} // namespace touchstone
