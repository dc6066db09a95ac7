#pragma once

#include "devices/choice/device_choice.h"

#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// What may be held instead of the mouse, and what is. Main thread.
class DeviceMenu {
  public:
    /// Looks again for what is plugged in, every kRenewal s. `now`: s, any steady clock.
    void renew(double now);
    [[nodiscard]] const std::vector<DeviceOffer>& offers() const { return offers_; }

    /// Opens what `choice` names (openDevice); empty lets go of what is held. What cannot be opened is said
    /// by `status` and nothing is held.
    std::shared_ptr<LinkedDevice> choose(const std::string& choice);
    [[nodiscard]] const std::string& chosen() const { return chosen_; }
    /// How it is with the chosen device: where it is, or what is wrong and the remedy.
    [[nodiscard]] std::string status() const;

  private:
    static constexpr double kRenewal = 2.0;

    std::vector<DeviceOffer> offers_;
    std::shared_ptr<LinkedDevice> device_;
    std::string chosen_, problem_;
    double renewed_ = -kRenewal;
};

/// Opens the device of `--device` for a command without a window; null for the simulated hand ("hand", and
/// "auto" where nothing is plugged in). Throws Error, also when the device may not be used. One that is not
/// plugged in yet is waited for while the command runs, which stderr says.
[[nodiscard]] std::unique_ptr<LinkedDevice> openDeviceOrHand(const std::string& choice);

} // namespace touchstone
