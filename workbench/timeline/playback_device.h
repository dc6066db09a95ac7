#pragma once
// Replays the hand of a recording through the running servo.

#include "devices/device/device.h"
#include "engine/exchange/handover.h"
#include "workbench/hand/glide.h"

#include <glm/glm.hpp>

#include <atomic>
#include <limits>
#include <memory>
#include <vector>

namespace touchstone {

/// The recorded hand's path in time. Immutable except its start time; the servo reads it.
class RecordedPath {
  public:
    struct Sample {
        double seconds = 0.0; ///< since the first one; increasing
        glm::dvec3 position{0.0};
        bool valid = false;
    };
    struct Options {
        bool repeats = false; ///< periodic, gliding from its end to its start
        /// Of a moving scene: its period, s (0: static), and the phase at which the recording started. The
        /// path then starts at the same phase.
        double period = 0.0, phase = 0.0;
    };
    /// At least one sample.
    explicit RecordedPath(std::vector<Sample> samples) : RecordedPath(std::move(samples), Options{}) {}
    RecordedPath(std::vector<Sample> samples, const Options& options);

    [[nodiscard]] double length() const noexcept { return samples_.back().seconds; } ///< s
    /// Duration of one round, s: in a moving scene a multiple of its period, so that every round meets the
    /// same phase; the hand rests at the path's start until then.
    [[nodiscard]] double lap() const noexcept;
    [[nodiscard]] bool repeats() const noexcept { return options_.repeats; }
    /// s since the first sample, for the servo's `time`; negative before the start, beyond `length` while
    /// gliding back or after the end.
    [[nodiscard]] double secondsAt(double time) const noexcept;

    /// Servo thread.
    void begin(double earliest) const noexcept;
    [[nodiscard]] DeviceSample at(double time) const noexcept;
    /// Start on the servo's clock, s; infinite until it has started. Any thread.
    [[nodiscard]] double begun() const noexcept { return begun_.load(std::memory_order_relaxed); }

  private:
    std::vector<Sample> samples_;
    Options options_;
    mutable std::atomic<double> begun_{std::numeric_limits<double>::infinity()};
};

/// In front of the window's hand: while a recording is touched again, its samples replace the hand's own. A
/// held device then receives no force, since it is elsewhere: the samples declare no coupling
/// (DeviceMapping), and the safety stage fades the force out and in as for the clutch. Switching glides.
class PlaybackDevice final : public Device {
  public:
    static constexpr double kGlideTime = kHandGlideTime;       ///< s
    static constexpr double kCouplingTime = kHandCouplingTime; ///< s, for the force to fade in after it

    explicit PlaybackDevice(Device& own) : own_(own) {}

    /// Owner thread. Null: the live hand.
    void follow(std::shared_ptr<const RecordedPath> path) { path_.offer(std::move(path)); }
    /// Frees what the servo no longer uses.
    void collect() { path_.collect(); }

    [[nodiscard]] std::string name() const override { return own_.name(); }
    [[nodiscard]] DeviceLimits limits() const override;
    void feel(const TouchFeedback& felt) noexcept override;
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand& command) noexcept override { own_.apply(command); }
    [[nodiscard]] PadLimits pad() const noexcept override { return own_.pad(); }
    void applyPad(const PadCommand& command) noexcept override { own_.applyPad(command); }

  private:
    Device& own_;
    Handover<RecordedPath> path_;
    // Servo thread:
    const RecordedPath* followed_ = nullptr;
    glm::dvec3 last_{0.0}, glideFrom_{0.0}; // workspace
    Similarity lastMap_;                    // of the last tick
    double glideStart_ = 0.0, lastTime_ = 0.0;
    double coupling_ = 1.0;
    bool started_ = false, gliding_ = false;
};

} // namespace touchstone
