#pragma once

#include "devices/device.h"
#include "devices/workspace_map.h"

#include <algorithm>
#include <atomic>

namespace touchstone {

/// The device's second button, as a bit of DeviceSample::buttons.
inline constexpr uint32_t kClutchButton = 1u << 1;

/// A device with a workspace of its own: its second button is the clutch.
class MappedDevice final : public Device {
  public:
    /// `device` outlives it. `place`: the workspace's point at which device and workspace agree at first.
    MappedDevice(Device& device, double zoom, const glm::dvec3& place) : device_(device), zoom_(zoom) {
        map_.begin({.zoom = zoom}, place);
    }

    [[nodiscard]] std::string name() const override { return device_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return device_.limits(); }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        DeviceSample sample = device_.sample(time);
        const double dt = std::clamp(time - last_, 0.0, kLongestStep);
        last_ = time;
        map_.apply(
            sample,
            {.zoom = zoom_.load(std::memory_order_relaxed),
             .clutch = clutch_.load(std::memory_order_relaxed) || (sample.buttons & kClutchButton) != 0},
            dt);
        return sample;
    }
    void apply(const DeviceCommand& command) noexcept override { device_.apply(command); }

    /// Any thread.
    void zoom(double zoom) noexcept { zoom_.store(zoom, std::memory_order_relaxed); }
    void clutch(bool held) noexcept { clutch_.store(held, std::memory_order_relaxed); }

    /// s that fades and glides go on in one sample, however long it was in coming.
    static constexpr double kLongestStep = 0.010;

  private:
    Device& device_;
    std::atomic<double> zoom_;
    std::atomic<bool> clutch_{false};
    // Servo thread:
    WorkspaceMap map_;
    double last_ = 0.0;
};

} // namespace touchstone
