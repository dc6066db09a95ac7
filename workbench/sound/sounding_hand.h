#pragma once

#include "devices/device/device.h"
#include "sound/live_sound.h"

#include <atomic>
#include <cmath>

namespace touchstone {

/// A tick as input of the sound. `dt`: s since the previous one.
[[nodiscard]] inline SoundTick soundTick(double dt, const DeviceSample& sample, const DeviceCommand& command,
                                         double impact = 0.0) {
    const glm::dvec3 place = sample.inWorkspace();
    const bool finite = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
    return {.dt = dt,
            .position = place,
            .force = sample.mapping.workspaceFromDevice.direction(command.force()),
            .impact = impact,
            .handKnown = sample.valid && finite}; // a non-finite position would contaminate all later output
}

/// A hand whose force is audible: the servo uses it instead of `hand`, and it forwards to `hand` and `feed`.
/// So sound comes after the tick, like a device, and renders the force commanded to the device.
class SoundingHand final : public Device {
  public:
    /// Both outlive it.
    SoundingHand(Device& hand, SoundFeed& feed) : hand_(hand), feed_(feed) {}
    /// Before the servo starts: that of the scene's bodies (ServoLoop::impact), which outlives it.
    void hear(const std::atomic<double>& impact) noexcept { impact_ = &impact; }

    [[nodiscard]] std::string name() const override { return hand_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return hand_.limits(); }
    [[nodiscard]] PadLimits pad() const noexcept override { return hand_.pad(); }
    void applyPad(const PadCommand& command) noexcept override { hand_.applyPad(command); }
    void feel(const TouchFeedback& felt) noexcept override { hand_.feel(felt); }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        sampled_ = time;
        return last_ = hand_.sample(time);
    }
    void apply(const DeviceCommand& command) noexcept override {
        hand_.apply(command);
        const double dt = sampled_ - applied_;
        applied_ = sampled_;
        if (dt > 0.0 && dt < kLongest) // otherwise the servo has restarted or ended
            feed_.add(soundTick(dt, last_, command,
                                impact_ != nullptr ? impact_->load(std::memory_order_relaxed) : 0.0));
    }

  private:
    static constexpr double kLongest = 0.1; // s

    Device& hand_;
    SoundFeed& feed_;
    const std::atomic<double>* impact_ = nullptr;
    // Servo thread:
    DeviceSample last_;
    double sampled_ = 0.0, applied_ = 0.0; // s
};

} // namespace touchstone
