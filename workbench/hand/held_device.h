#pragma once

#include "workbench/hand/device_menu.h"
#include "workbench/hand/device_multiplexer.h"

#include <memory>
#include <string>

namespace touchstone {

/// Takes up the chosen device. A device is driven only with a scene compiled for its limits: it waits until
/// the servo has adopted that scene; meanwhile no device is in use. Main thread.
class HeldDevice {
  public:
    explicit HeldDevice(DeviceMultiplexer& hand) : hand_(hand) {}

    /// Every frame. `choice` becomes the actual choice: empty where it cannot be opened. True where the scene
    /// must be offered again with `limits`.
    [[nodiscard]] bool choose(std::string& choice);
    /// The servo touches a scene compiled for `limits`, or none.
    void limitsHold();
    /// Releases the last choice.
    void drop(std::string& choice);

    /// Of the current or next device.
    [[nodiscard]] DeviceLimits limits() const;
    [[nodiscard]] DeviceMenu& menu() { return menu_; }
    [[nodiscard]] const DeviceMenu& menu() const { return menu_; }

  private:
    DeviceMultiplexer& hand_;
    DeviceMenu menu_;
    std::shared_ptr<LinkedDevice> coming_;
};

} // namespace touchstone
