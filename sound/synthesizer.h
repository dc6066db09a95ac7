#pragma once
// The sound of a touch, from end to end and without a sound card: ticks in, frames out (docs/sound.md).

#include "sound/force_change.h"
#include "sound/loudness.h"
#include "sound/tick_stretcher.h"

#include <span>

namespace touchstone {

/// Pressing leans to the left ear and dragging to the right one, so that they never cancel in both.
/// Any one thread; no allocation after construction. Deterministic.
class Synthesizer {
  public:
    /// `rate`: frames a second.
    explicit Synthesizer(double rate) : rate_(rate), stretcher_(rate), loudness_(rate) {}

    /// False where more ticks wait than there is room for (4000): this one is left out.
    bool push(const SoundTick& tick) noexcept { return stretcher_.push(change_.add(tick), tick.dt); }
    /// As many frames as the ticks are enough for, at most `frames`; |left|, |right| <= 1. `speed`: see
    /// TickStretcher::pop. Returns how many.
    size_t render(std::span<SoundFrame> frames, double speed = 1.0) noexcept;

    [[nodiscard]] double rate() const noexcept { return rate_; }
    [[nodiscard]] double framesAhead() const noexcept { return stretcher_.ahead(); }
    void skip(double frames) noexcept { stretcher_.skip(frames); }
    void reset() noexcept;

    /// s from a tick to its sound, besides what waits before and behind: `dt` of a tick.
    [[nodiscard]] static double delay(double dt) noexcept {
        return static_cast<double>(TickStretcher::kReach) * dt + Loudness::kLookAhead;
    }

  private:
    double rate_;
    ForceChange change_;
    TickStretcher stretcher_;
    Loudness loudness_;
};

} // namespace touchstone
