#pragma once
// The whole sound path without a sound card: ticks in, frames out (docs/sound.md).

#include "sound/force_change.h"
#include "sound/loudness.h"
#include "sound/tick_stretcher.h"

#include <span>

namespace touchstone {

/// Pressing is panned to the left and dragging to the right, so that they never cancel in both channels. Any
/// one thread; no allocation after construction. Deterministic.
class Synthesizer {
  public:
    /// `rate`: frames per second.
    explicit Synthesizer(double rate) : rate_(rate), stretcher_(rate), loudness_(rate) {}

    /// False if the queue (4000 ticks) is full: the tick is dropped.
    bool push(const SoundTick& tick) noexcept { return stretcher_.push(change_.add(tick), tick.dt); }
    /// Renders as many frames as the ticks allow, at most `frames`; |left|, |right| <= 1. `speed`: see
    /// TickStretcher::pop. Returns their number.
    size_t render(std::span<SoundFrame> frames, double speed = 1.0) noexcept;

    [[nodiscard]] double rate() const noexcept { return rate_; }
    [[nodiscard]] double framesAhead() const noexcept { return stretcher_.ahead(); }
    void skip(double frames) noexcept { stretcher_.skip(frames); }
    void reset() noexcept;

    /// s from a tick to its sound, without queues before and after: `dt` of a tick.
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
