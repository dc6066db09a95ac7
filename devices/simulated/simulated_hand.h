#pragma once

#include "devices/device/device.h"
#include "devices/stroke/stroke_path.h"

#include <memory>
#include <optional>
#include <utility>

namespace touchstone {

/// Follows a path in time, whatever the force (HandImpedance adds the response to force). Deterministic: the
/// position depends on the time and the animation's alone.
class SimulatedHand final : public Device {
  public:
    /// `wait`: s at the path's start before it sets off.
    explicit SimulatedHand(std::shared_ptr<const StrokePath> path, double wait = 0.0)
        : path_(std::move(path)), wait_(wait) {}

    [[nodiscard]] std::string name() const override { return "simulated hand"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    /// The animation's time, at which a path that it carries is; else that of the sample.
    void feel(const TouchFeedback& felt) noexcept override { animation_ = felt.animation; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand&) noexcept override {}

    [[nodiscard]] const StrokePath& path() const { return *path_; }

  private:
    std::shared_ptr<const StrokePath> path_;
    double wait_ = 0.0;
    std::optional<double> animation_; // s
    bool begun_ = false;
};

} // namespace touchstone
