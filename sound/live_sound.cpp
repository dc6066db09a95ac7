#include "sound/live_sound.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

SoundPlayer::SoundPlayer(SoundFeed& feed, double rate)
    : feed_(feed), synthesizer_(rate), gateStep_(static_cast<float>(1.0 / (kFade * rate))),
      volumeShare_(static_cast<float>(-std::expm1(-1.0 / (kVolumeTime * rate)))) {}

void SoundPlayer::collect() noexcept {
    constexpr double kMeanShare = 0.05; // weight of the latest tick
    SoundTick tick;
    while (feed_.pop(tick)) {
        dt_ += kMeanShare * (tick.dt - dt_);
        (void)synthesizer_.push(tick); // on overflow the surplus is skipped below
    }
}

/// Starts and stops, and returns the speed for this block.
double SoundPlayer::speedFor(size_t frames) noexcept {
    // Frames, since ticks may be late: one that took ten times as long counts ten times.
    const double rate = synthesizer_.rate(), ahead = synthesizer_.framesAhead();
    const double wanted = static_cast<double>(frames) + kCushion * rate;
    if (!playing_) {
        playing_ = ahead >= wanted;
        bend_ = 0.0;
    }
    if (playing_ && ahead > wanted + kTooMuch * rate)
        skipping_ = true;
    if (skipping_ && gate_ <= 0.0f) {
        synthesizer_.skip(ahead - wanted);
        leftOut_.fetch_add(1, std::memory_order_relaxed);
        skipping_ = false;
    }
    if (interrupted_.exchange(false, std::memory_order_relaxed))
        silentFrames_ = static_cast<size_t>(kSwapSilence * rate);
    constexpr double kShare = 0.05; // weight of the latest block: averages out the servo's jitter
    bend_ += kShare * (std::clamp((ahead - wanted) / wanted, -1.0, 1.0) - bend_);
    latency_.store(ahead / rate + Synthesizer::delay(dt_), std::memory_order_relaxed);
    return 1.0 + kMaxBend * bend_;
}

/// One frame at full volume; after the last tick, that tick, which fades out.
SoundFrame SoundPlayer::next(double speed) noexcept {
    if (playing_ && synthesizer_.render({&last_, 1}, speed) == 0) {
        playing_ = false;
        runsDry_.fetch_add(1, std::memory_order_relaxed);
    }
    if (silentFrames_ > 0)
        --silentFrames_;
    const bool open = playing_ && !skipping_ && silentFrames_ == 0;
    gate_ = std::clamp(gate_ + (open ? gateStep_ : -gateStep_), 0.0f, 1.0f);
    return {gate_ * last_.left, gate_ * last_.right};
}

void SoundPlayer::fill(std::span<SoundFrame> frames) noexcept {
    collect();
    const double speed = speedFor(frames.size());
    const float volume = std::clamp(volume_.load(std::memory_order_relaxed), 0.0f, 1.0f);
    float peak = 0.0f;
    for (SoundFrame& frame : frames) {
        loud_ += volumeShare_ * (volume - loud_);
        const SoundFrame full = next(speed);
        frame = {loud_ * full.left, loud_ * full.right};
        peak = std::max({peak, std::abs(frame.left), std::abs(frame.right)});
    }
    peak_.store(peak, std::memory_order_relaxed);
}

SoundPlayer::Figures SoundPlayer::figures() const noexcept {
    return {latency_.load(std::memory_order_relaxed), peak_.load(std::memory_order_relaxed),
            runsDry_.load(std::memory_order_relaxed), leftOut_.load(std::memory_order_relaxed)};
}

} // namespace touchstone
