#pragma once

#include "workbench/hand/device_menu.h"
#include "workbench/hand/device_multiplexer.h"

#include <memory>
#include <string>

namespace touchstone {

/// Who holds what: takes up the device that was chosen. A device is driven only by a scene with its own
/// limits: it waits until the servo has adopted that; meanwhile nothing is held. Main thread.
class HeldDevice {
  public:
    explicit HeldDevice(DeviceMultiplexer& hand) : hand_(hand) {}

    /// In every frame. `choice` becomes what is really chosen: empty where it cannot be opened. True where
    /// the scene has to be offered anew with `limits`.
    [[nodiscard]] bool choose(std::string& choice);
    /// The servo touches a scene that was made with `limits`, or none.
    void limitsHold();
    /// Lets go of what was chosen last.
    void drop(std::string& choice);

    /// Of what is held or will be next.
    [[nodiscard]] DeviceLimits limits() const;
    [[nodiscard]] DeviceMenu& menu() { return menu_; }
    [[nodiscard]] const DeviceMenu& menu() const { return menu_; }

  private:
    DeviceMultiplexer& hand_;
    DeviceMenu menu_;
    std::shared_ptr<LinkedDevice> coming_;
};

} // namespace touchstone
