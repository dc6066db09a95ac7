#pragma once

#include "api/c/tick_arrays.h"
#include "api/c/touched_scene.h"
#include "devices/device/mapped_device.h"
#include "devices/link/linked_device.h"
#include "devices/plant/hand_impedance.h"
#include "devices/simulated/simulated_hand.h"
#include "haptics/servo/servo_loop.h"

#include <deque>
#include <memory>
#include <string>

namespace touchstone::api {

/// A number of a struct of the caller's: `usual` where it is 0. Throws Refused where it is not above 0.
[[nodiscard]] double limitOr(double given, double usual, const std::string& argument);

/// A device of the caller's: two functions.
class CallersDevice final : public Device {
  public:
    /// `argument`: its name, for messages. Throws Refused.
    CallersDevice(const ts_device& device, const std::string& argument);
    [[nodiscard]] std::string name() const override { return "own device"; }
    [[nodiscard]] DeviceLimits limits() const override { return limits_; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand& command) noexcept override;

  private:
    ts_device device_;
    DeviceLimits limits_;
};

/// A hand of a session: a device, one of the caller's, or a simulated hand that strokes what is touched.
class LiveHand {
  public:
    /// Opens the device; `argument`: what the struct that names it is called. Throws Refused, and Error where
    /// the device cannot be opened.
    LiveHand(const char* device, const ts_device* own, const std::string& argument);

    [[nodiscard]] bool simulated() const { return !stroke_.empty(); }
    /// What a simulated hand strokes on a scene, which keeps it; null for others. Throws where no stroke can
    /// be laid.
    std::shared_ptr<const StrokePath> layStroke(TouchedScene& scene) const;
    /// The device for a new servo, which this outlives. A simulated hand strokes the scene, and begins `late`
    /// (0..1) of the stroke's period after the start.
    [[nodiscard]] Device& connect(TouchedScene& scene, double late);

    /// A tick; `keep`: how many are kept.
    void take(const TickRecord& record, size_t keep);
    [[nodiscard]] const TickRecord& newest() const { return newest_; }
    /// The oldest kept ticks into the arrays; returns their number.
    size_t takeKept(const TickArrays& ticks);

  private:
    std::string stroke_; // of a simulated hand; empty: a device
    std::unique_ptr<CallersDevice> own_;
    std::unique_ptr<LinkedDevice> linked_;
    std::unique_ptr<SimulatedHand> path_;
    std::unique_ptr<HandImpedance> yielding_;
    std::unique_ptr<MappedDevice> mapped_;
    TickRecord newest_;
    std::deque<TickRow> kept_;
};

} // namespace touchstone::api
