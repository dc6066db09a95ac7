#pragma once
// Lock-free transfer from the servo to the audio thread.

#include "engine/exchange/record_ring.h"
#include "sound/sound_source.h"
#include "sound/synthesizer.h"

#include <atomic>
#include <cstdint>
#include <span>

namespace touchstone {

/// The servo's end: a separate ring, since that of the tick records belongs to the window, which reads it
/// once per frame, with a delay of thirty milliseconds and more.
class SoundFeed {
  public:
    /// Servo thread; wait-free. A tick costs one load without a listener.
    void add(const SoundTick& tick) noexcept {
        if (heard_.load(std::memory_order_relaxed))
            ticks_.push(tick);
    }
    /// Any thread.
    void listen(bool on) noexcept { heard_.store(on, std::memory_order_relaxed); }
    /// The player's thread.
    bool pop(SoundTick& tick) noexcept { return ticks_.pop(tick); }
    [[nodiscard]] bool heard() const noexcept { return heard_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> heard_{false};
    RecordRing<SoundTick> ticks_{2048}; // half a second at 4 kHz
};

/// The player's end. Servo and sound card have different clocks, and the servo may pause: the player queues
/// the ticks of a block plus a margin, plays up to kMaxBend faster or slower to hold that level, and fades
/// out on underrun or overflow.
class SoundPlayer final : public SoundSource {
  public:
    static constexpr double kCushion = 0.004;   ///< s of ticks beyond a block: margin for the servo's jitter
    static constexpr double kTooMuch = 0.06;    ///< s beyond that: then old ticks are skipped
    static constexpr double kMaxBend = 0.005;   ///< fraction of the speed: 9 cents of pitch
    static constexpr double kFade = 0.004;      ///< s, from silence to full and back
    static constexpr double kVolumeTime = 0.01; ///< s, transition to a new volume

    /// `rate`: frames per second. The feed outlives it.
    SoundPlayer(SoundFeed& feed, double rate);

    /// The player's thread (a sound card's callback): no allocation, lock or wait. |left|, |right| <= the
    /// volume.
    void fill(std::span<SoundFrame> frames) noexcept override;

    /// Any thread; 0..1.
    void setVolume(float volume) noexcept override { volume_.store(volume, std::memory_order_relaxed); }
    /// Any thread: fades to silence for kSwapSilence, before another model is touched.
    void interrupt() noexcept { interrupted_.store(true, std::memory_order_relaxed); }
    static constexpr double kSwapSilence = 0.1; ///< s

    struct Figures {
        double latency = 0.0; ///< mean s from a tick to the end of the `fill` that plays it
        float peak = 0.0f;    ///< of the last block, fraction of full scale
        uint64_t runsDry = 0; ///< number of underruns
        uint64_t leftOut = 0; ///< number of times that old ticks were skipped
    };
    [[nodiscard]] Figures figures() const noexcept; ///< any thread

  private:
    void collect() noexcept;
    double speedFor(size_t frames) noexcept;
    SoundFrame next(double speed) noexcept;

    SoundFeed& feed_;
    Synthesizer synthesizer_;
    std::atomic<float> volume_{0.0f};
    std::atomic<bool> interrupted_{false};
    std::atomic<double> latency_{0.0};
    std::atomic<float> peak_{0.0f};
    std::atomic<uint64_t> runsDry_{0}, leftOut_{0};
    // The player's thread:
    double dt_ = 1e-3; // s, mean duration of a tick
    bool playing_ = false, skipping_ = false;
    size_t silentFrames_ = 0; // remaining, after an interruption
    double bend_ = 0.0;
    float gate_ = 0.0f, gateStep_, loud_ = 0.0f, volumeShare_;
    SoundFrame last_;
};

} // namespace touchstone
