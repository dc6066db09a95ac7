#pragma once

#include "session/tick_subscriber.h"
#include "workbench/hand/device_multiplexer.h"

#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// The window's hands beside the first: each a device of its own, or a simulated hand. Their number is fixed,
/// as is that of the servo's ports. Main thread.
class OtherHands final : public TickSubscriber {
  public:
    /// `choices`: "hand" or as openDevice. `zoom`: workspace metres for one metre of a device. Throws as
    /// openDevice, and where no device is plugged in for "auto".
    OtherHands(const std::vector<std::string>& choices, double zoom);

    [[nodiscard]] bool empty() const { return hands_.empty(); }
    /// For the servo, which must end before this object.
    [[nodiscard]] std::vector<DevicePort> ports();

    /// As those of DeviceMultiplexer, of each hand. On one path the hands are as far apart as can be.
    void offerPath(const std::shared_ptr<const StrokePath>& path);
    void leave() noexcept;
    void face(const glm::dquat& deviceFromView);
    void collect();

    /// What the window shows of one hand.
    struct State {
        std::string name;
        std::string status; ///< where its device is, or its problem
        TickRecord tick;    ///< the newest
    };
    [[nodiscard]] const std::vector<State>& states() const { return states_; }

    void take(const TickRecord& record, const HapticSettings& settings) override;
    void flush(double now) override;

  private:
    struct Hand {
        std::shared_ptr<LinkedDevice> device; // null: simulated
        DeviceMultiplexer place;
    };
    std::vector<std::unique_ptr<Hand>> hands_;
    std::vector<State> states_;
};

} // namespace touchstone
