#pragma once
// From ticks to the frames of a sound card, band-limited.

#include "sound/force_change.h"

#include <array>
#include <cstddef>

namespace touchstone {

/// Two channels, press and drag, N/s.
struct StretchedFrame {
    float press = 0.0f, drag = 0.0f;
};

/// Interpolates between ticks by a sinc of 16 taps under a Kaiser window (beta 6), cut off at half of the
/// ticks' rate: what the ticks carry stays, no image of it is added (docs/sound.md has how well). Not
/// libsamplerate, whose fastest sinc is 19 ticks late (this one 8) and knows no ticks of different length.
/// Any one thread; no allocation.
class TickStretcher {
  public:
    static constexpr size_t kReach = 8;       ///< ticks on either side of a frame
    static constexpr size_t kCapacity = 4096; ///< ticks, a power of two

    /// `rate`: frames a second.
    explicit TickStretcher(double rate);

    /// False, and nothing is taken, where kCapacity ticks wait.
    bool push(const ForceRates& rates, double dt) noexcept;
    /// The next frame; `speed` 1.01 plays ticks 1 % shorter. False where it needs ticks that are not there
    /// yet.
    bool pop(StretchedFrame& frame, double speed = 1.0) noexcept;
    /// Frames that can be played before the ticks run out, at speed 1. Time grows with the ticks that wait.
    [[nodiscard]] double ahead() const noexcept;
    /// Goes on up to `frames` later, by whole ticks, as far as there are any.
    void skip(double frames) noexcept;
    void reset() noexcept;

  private:
    static constexpr size_t kTaps = 2 * kReach, kPhases = 256;
    struct Tick {
        float press = 0.0f, drag = 0.0f;
        float frames = 1.0f; // that it lasts
    };
    [[nodiscard]] const Tick& at(size_t index) const noexcept { return ticks_[index & (kCapacity - 1)]; }

    double rate_;
    std::array<std::array<float, kTaps>, kPhases + 1> kernel_;
    std::array<Tick, kCapacity> ticks_{};
    size_t end_ = kReach;       // index of the next tick; those before the first are silent
    size_t begin_ = kReach - 1; // the frame lies between this tick and the next
    double phase_ = 0.0;        // 0..1 from the one to the other
};

} // namespace touchstone
