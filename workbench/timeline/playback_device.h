#pragma once
// The hand of a recording, once more, through the servo that touches now.

#include "devices/device/device.h"
#include "engine/exchange/handover.h"
#include "workbench/hand/glide.h"

#include <glm/glm.hpp>

#include <atomic>
#include <limits>
#include <memory>
#include <vector>

namespace touchstone {

/// Where a recorded hand was, in time. Immutable but for when it began; the servo reads it.
class RecordedPath {
  public:
    struct Sample {
        double seconds = 0.0; ///< since the first one; grows
        glm::dvec3 position{0.0};
        bool valid = false;
    };
    struct Options {
        bool repeats = false; ///< goes round for ever, gliding from its end to its begin
        /// Of what moves in the scene: s after which it is where it was, 0 where nothing moves, and where in
        /// that the recording began. The path then begins when the model is where it was.
        double period = 0.0, phase = 0.0;
    };
    /// At least one sample.
    explicit RecordedPath(std::vector<Sample> samples) : RecordedPath(std::move(samples), Options{}) {}
    RecordedPath(std::vector<Sample> samples, const Options& options);

    [[nodiscard]] double length() const noexcept { return samples_.back().seconds; } ///< s
    /// From one round to the next, s: with what moves, a multiple of its period, so that every round finds
    /// it where it was; the hand rests at the path's begin until then.
    [[nodiscard]] double lap() const noexcept;
    [[nodiscard]] bool repeats() const noexcept { return options_.repeats; }
    /// s since the first sample, of what is touched `time`; below zero before it began, beyond `length` while
    /// gliding back or after the end.
    [[nodiscard]] double secondsAt(double time) const noexcept;

    /// Servo thread.
    void begin(double earliest) const noexcept;
    [[nodiscard]] DeviceSample at(double time) const noexcept;
    /// On the servo's clock, s; infinite until it is taken up. Any thread.
    [[nodiscard]] double begun() const noexcept { return begun_.load(std::memory_order_relaxed); }

  private:
    std::vector<Sample> samples_;
    Options options_;
    mutable std::atomic<double> begun_{std::numeric_limits<double>::infinity()};
};

/// Stands before the window's hand: while a recording is touched again its samples take the place of the
/// hand's own, and the device that is held gets no force, since it is somewhere else: the samples say that
/// nothing is coupled (DeviceMapping), and the safety stage takes the force away and gives it back as it does
/// for the clutch. Going over glides.
class PlaybackDevice final : public Device {
  public:
    static constexpr double kGlideTime = kHandGlideTime;       ///< s
    static constexpr double kCouplingTime = kHandCouplingTime; ///< s, from no force to all of it

    explicit PlaybackDevice(Device& own) : own_(own) {}

    /// Owner thread. Null: the own hand.
    void follow(std::shared_ptr<const RecordedPath> path) { path_.offer(std::move(path)); }
    /// Frees what the servo has let go.
    void collect() { path_.collect(); }

    [[nodiscard]] std::string name() const override { return own_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return own_.limits(); }
    void feel(const TouchFeedback& felt) noexcept override;
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand& command) noexcept override { own_.apply(command); }

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
