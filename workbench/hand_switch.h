#pragma once

#include "devices/mouse_device.h"
#include "devices/stroke_path.h"
#include "engine/exchange/handover.h"

#include <atomic>
#include <memory>

namespace touchstone {

/// The window's hand: the mouse, or a simulated hand on a path that comes with the model. Changing over
/// glides from where the hand is to where the other one is, so that nothing is struck at the speed of a jump.
class HandSwitch final : public Device {
  public:
    /// s that changing over takes.
    static constexpr double kGlideTime = 0.4;

    /// Owner thread.
    void simulate(bool simulated) noexcept { simulated_.store(simulated, std::memory_order_relaxed); }
    [[nodiscard]] bool simulated() const noexcept { return simulated_.load(std::memory_order_relaxed); }
    void offerPath(std::shared_ptr<const StrokePath> path) { path_.offer(std::move(path)); }
    [[nodiscard]] MouseDevice& mouse() { return mouse_; }

    [[nodiscard]] std::string name() const override { return simulated() ? "simulated hand" : "mouse"; }
    [[nodiscard]] DeviceLimits limits() const override { return mouse_.limits(); }
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand&) noexcept override {}

  private:
    MouseDevice mouse_;
    std::atomic<bool> simulated_{false};
    Handover<StrokePath> path_;
    // Servo thread:
    const StrokePath* followed_ = nullptr; // null: the mouse
    glm::dvec3 last_{0.0}, glideFrom_{0.0};
    double glideStart_ = 0.0;
    bool started_ = false, gliding_ = false;
};

} // namespace touchstone
