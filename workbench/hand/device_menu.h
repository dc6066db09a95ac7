#pragma once

#include "devices/choice/device_choice.h"

#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// The available devices and the one in use. Main thread.
class DeviceMenu {
  public:
    /// Searches for plugged-in devices, every kRenewal s. `now`: s, any steady clock.
    void renew(double now);
    [[nodiscard]] const std::vector<DeviceOffer>& offers() const { return offers_; }

    /// Opens the device of `choice` (openDevice); empty: releases the current one. On failure `status` gives
    /// the reason and nothing is held.
    std::shared_ptr<LinkedDevice> choose(const std::string& choice);
    [[nodiscard]] const std::string& chosen() const { return chosen_; }
    /// State of the chosen device: its location, or the problem with its remedy.
    [[nodiscard]] std::string status() const;

  private:
    static constexpr double kRenewal = 2.0;

    std::vector<DeviceOffer> offers_;
    std::shared_ptr<LinkedDevice> device_;
    std::string chosen_, problem_;
    double renewed_ = -kRenewal;
};

/// Opens the device of `--device` for a command without a window; null for the simulated hand ("hand", and
/// "auto" where nothing is plugged in). Throws Error, also without permission for the device. The command
/// waits for a device that is not plugged in yet and reports so on stderr.
[[nodiscard]] std::unique_ptr<LinkedDevice> openDeviceOrHand(const std::string& choice);

} // namespace touchstone
