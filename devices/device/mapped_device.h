#pragma once

#include "devices/device/device.h"
#include "devices/device/workspace_map.h"

namespace touchstone {

/// A device with a workspace map; its second button is the clutch.
class MappedDevice final : public Device {
  public:
    /// `device` outlives it. `place`: the workspace point at which device and workspace initially coincide.
    MappedDevice(Device& device, double zoom, const glm::dvec3& place) : device_(device), zoom_(zoom) {
        map_.begin({.zoom = zoom}, place);
    }

    [[nodiscard]] std::string name() const override { return device_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return device_.limits(); }
    void feel(const TouchFeedback& felt) noexcept override { device_.feel(felt); }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        DeviceSample sample = device_.sample(time);
        map_.apply(sample, {.zoom = zoom_, .clutch = (sample.buttons & kClutchButton) != 0}, time - last_);
        last_ = time;
        return sample;
    }
    void apply(const DeviceCommand& command) noexcept override { device_.apply(command); }
    [[nodiscard]] PadLimits pad() const noexcept override { return device_.pad(); }
    void applyPad(const PadCommand& command) noexcept override { device_.applyPad(command); }

  private:
    Device& device_;
    double zoom_;
    // Servo thread:
    WorkspaceMap map_;
    double last_ = 0.0;
};

} // namespace touchstone
