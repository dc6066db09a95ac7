#pragma once
// Hands without a path of their own: what moves them is outside.

#include "devices/device/device.h"

#include <functional>

namespace touchstone {

/// Is in the next tick where its owner puts it, whatever the force. One thread.
class ToldHand final : public Device {
  public:
    [[nodiscard]] std::string name() const override { return "told"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] DeviceSample sample(double) noexcept override { return next; }
    void apply(const DeviceCommand&) noexcept override {}

    DeviceSample next;
};

/// Is at every time where a function says, m of the workspace over s, whatever the force: what a simulated
/// hand (HandImpedance) intends. The function outlives it, and does not throw.
class IntendedHand final : public Device {
  public:
    explicit IntendedHand(const std::function<glm::dvec3(double)>& intention) : intention_(intention) {}
    [[nodiscard]] std::string name() const override { return "intention"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        return {.position = intention_(time), .valid = true};
    }
    void apply(const DeviceCommand&) noexcept override {}

  private:
    const std::function<glm::dvec3(double)>& intention_;
};

} // namespace touchstone
