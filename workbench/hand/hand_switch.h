#pragma once

#include "devices/link/linked_device.h"
#include "devices/mouse_device.h"
#include "devices/stroke_path.h"
#include "engine/exchange/handover.h"

#include <atomic>
#include <memory>

namespace touchstone {

/// The window's hand: the mouse, a simulated hand on a path that comes with the model, or a device. Changing
/// over glides from where the hand is to where the other one is, so that nothing is struck at the speed of a
/// jump.
class HandSwitch final : public Device {
  public:
    /// s that changing over takes.
    static constexpr double kGlideTime = 0.4;

    /// Owner thread.
    void simulate(bool simulated) noexcept { simulated_.store(simulated, std::memory_order_relaxed); }
    [[nodiscard]] bool simulated() const noexcept { return simulated_.load(std::memory_order_relaxed); }
    void offerPath(std::shared_ptr<const StrokePath> path) { path_.offer(std::move(path)); }
    /// Null: back to the mouse or the simulated hand. A device that is let go gets zero force.
    void hold(std::shared_ptr<LinkedDevice> device);
    /// How the user looks at the workspace: LinkedDevice::face.
    void face(const glm::dquat& deviceFromView);
    /// Frees what the servo has let go.
    void collect() { held_.collect(); }
    [[nodiscard]] MouseDevice& mouse() { return mouse_; }

    [[nodiscard]] std::string name() const override;
    [[nodiscard]] DeviceLimits limits() const override;
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand& command) noexcept override;

  private:
    struct Held {
        std::shared_ptr<LinkedDevice> device; // null: none
    };

    MouseDevice mouse_;
    std::shared_ptr<LinkedDevice> device_; // owner thread
    Handover<Held> held_;
    std::atomic<bool> simulated_{false};
    Handover<StrokePath> path_;
    // Servo thread:
    const void* followed_ = nullptr; // the path or the device; null: the mouse
    LinkedDevice* driven_ = nullptr; // in this tick
    glm::dvec3 last_{0.0}, glideFrom_{0.0};
    double glideStart_ = 0.0;
    bool started_ = false, gliding_ = false;
};

} // namespace touchstone
