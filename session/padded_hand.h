#pragma once
// A hand whose contact location display shows where its pad touches a scene.

#include "devices/device/device.h"
#include "haptics/finger/finger_pad.h"
#include "haptics/safety/location_limiter.h"

#include <atomic>
#include <cmath>

namespace touchstone {

/// Between the servo and a hand. The location follows from the direction of the last tick's spring, which
/// lies along the shaded normal, and the orientation of this tick's sample. A hand without a display pays a
/// call. Servo thread.
class PaddedHand final : public Device {
  public:
    /// `hand` outlives it.
    explicit PaddedHand(Device& hand) : hand_(hand) {}

    [[nodiscard]] std::string name() const override { return hand_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return hand_.limits(); }
    [[nodiscard]] PadLimits pad() const noexcept override { return hand_.pad(); }
    void feel(const TouchFeedback& felt) noexcept override {
        const glm::dvec3 out = felt.proxy - felt.hip;
        const double length = glm::length(out);
        touching_ = felt.touching && length > 0.0 && std::isfinite(length);
        if (touching_)
            normal_ = out / length;
        hand_.feel(felt);
    }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        const DeviceSample sample = hand_.sample(time);
        turn_ = sample.mapping.workspaceFromDevice.rotation * sample.orientation;
        known_ = sample.valid;
        dt_ = time - time_;
        time_ = time;
        return sample;
    }
    void apply(const DeviceCommand& command) noexcept override {
        const PadLimits limits = hand_.pad();
        // Also where there is no display: the next one begins in its middle, not where this one was.
        const PadCommand place = LocationLimiter::limit(FingerPad{}.locationOn(turn_, normal_),
                                                        touching_ && known_, limits, dt_, state_);
        if (limits.reach > 0.0 || shows_)
            show(place);
        shows_ = limits.reach > 0.0;
        hand_.apply(command);
    }

    /// Any thread: the last command, m; of two numbers that are read one after the other.
    [[nodiscard]] glm::dvec2 shown() const noexcept {
        return {along_.load(std::memory_order_relaxed), across_.load(std::memory_order_relaxed)};
    }

  private:
    void show(const PadCommand& command) noexcept {
        along_.store(command.location().x, std::memory_order_relaxed);
        across_.store(command.location().y, std::memory_order_relaxed);
        hand_.applyPad(command);
    }

    Device& hand_;
    LocationLimiterState state_;
    glm::dvec3 normal_{0.0, 1.0, 0.0}; // workspace, of the last contact
    glm::dquat turn_{1.0, 0.0, 0.0, 0.0};
    double time_ = 0.0, dt_ = 0.0; // s
    bool touching_ = false, known_ = false, shows_ = false;
    std::atomic<double> along_{0.0}, across_{0.0};
};

} // namespace touchstone
