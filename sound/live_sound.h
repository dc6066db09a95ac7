#pragma once
// From the servo to whatever plays, without either waiting for the other.

#include "engine/exchange/record_ring.h"
#include "sound/synthesizer.h"

#include <atomic>
#include <cstdint>
#include <span>

namespace touchstone {

/// The servo's end: a ring of its own, since that of the tick records belongs to the window, which reads it
/// once a frame, thirty and more milliseconds late.
class SoundFeed {
  public:
    /// Servo thread; wait-free. A tick costs one load while nobody listens.
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

/// The player's end. Servo and sound card have clocks of their own, and the servo may pause: the player keeps
/// as many ticks waiting as a block needs and some more, plays up to kMaxBend faster or slower to hold that,
/// and fades where it runs dry or far too many wait.
class SoundPlayer {
  public:
    static constexpr double kCushion = 0.004;   ///< s of ticks more than a block needs: the servo's jitter
    static constexpr double kTooMuch = 0.06;    ///< s more than that: then what is old is left out
    static constexpr double kMaxBend = 0.005;   ///< share of the speed: 9 cents of pitch
    static constexpr double kFade = 0.004;      ///< s, from silence to full and back
    static constexpr double kVolumeTime = 0.01; ///< s, until a new volume holds

    /// `rate`: frames a second. The feed outlives it.
    SoundPlayer(SoundFeed& feed, double rate);

    /// The player's thread (a sound card's callback): no allocation, lock or wait. |left|, |right| <= the
    /// volume.
    void fill(std::span<SoundFrame> frames) noexcept;

    /// Any thread; 0..1.
    void setVolume(float volume) noexcept { volume_.store(volume, std::memory_order_relaxed); }
    /// Any thread: silence for kSwapSilence, faded: another world is about to be touched.
    void interrupt() noexcept { interrupted_.store(true, std::memory_order_relaxed); }
    static constexpr double kSwapSilence = 0.1; ///< s

    struct Figures {
        double latency = 0.0; ///< s from a tick to the end of `fill` that plays it, in the mean
        float peak = 0.0f;    ///< of the last block, share of full scale
        uint64_t runsDry = 0; ///< times that there were no ticks when some were needed
        uint64_t leftOut = 0; ///< times that old ticks were left out
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
    double dt_ = 1e-3; // s, of a tick in the mean
    bool playing_ = false, skipping_ = false;
    size_t silentFrames_ = 0; // still to be, after an interruption
    double bend_ = 0.0;
    float gate_ = 0.0f, gateStep_, loud_ = 0.0f, volumeShare_;
    SoundFrame last_;
};

} // namespace touchstone
