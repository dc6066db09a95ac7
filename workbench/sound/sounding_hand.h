#pragma once

#include "devices/device/device.h"
#include "sound/live_sound.h"

#include <cmath>

namespace touchstone {

/// What a tick is to the ear. `dt`: s since the one before.
[[nodiscard]] inline SoundTick soundTick(double dt, const DeviceSample& sample,
                                         const DeviceCommand& command) {
    const glm::dvec3 place = sample.inWorkspace();
    const bool finite = std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
    return {.dt = dt,
            .position = place,
            .force = sample.mapping.workspaceFromDevice.direction(command.force()),
            .handKnown = sample.valid && finite}; // a place that is none would be heard for ever
}

/// A hand whose force is heard, too: the servo holds it in the place of `hand`, and what goes to that goes to
/// `feed` as well. So sound is where a device is, behind the tick, and hears what a device is told to push
/// with.
class SoundingHand final : public Device {
  public:
    /// Both outlive it.
    SoundingHand(Device& hand, SoundFeed& feed) : hand_(hand), feed_(feed) {}

    [[nodiscard]] std::string name() const override { return hand_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return hand_.limits(); }
    void feel(const TouchFeedback& felt) noexcept override { hand_.feel(felt); }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        sampled_ = time;
        return last_ = hand_.sample(time);
    }
    void apply(const DeviceCommand& command) noexcept override {
        hand_.apply(command);
        const double dt = sampled_ - applied_;
        applied_ = sampled_;
        if (dt > 0.0 && dt < kLongest) // else the servo has begun anew, or ended
            feed_.add(soundTick(dt, last_, command));
    }

  private:
    static constexpr double kLongest = 0.1; // s

    Device& hand_;
    SoundFeed& feed_;
    // Servo thread:
    DeviceSample last_;
    double sampled_ = 0.0, applied_ = 0.0; // s
};

} // namespace touchstone
