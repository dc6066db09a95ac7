#pragma once

#include "devices/link/linked_device.h"
#include "devices/mouse/mouse_device.h"

#include <memory>
#include <string>

namespace touchstone {

/// The hand of a session: the mouse, or a device that is held for all of it. Main thread.
class ExperimentHand {
  public:
    /// `choice`: openDevice's, "mouse" or empty: the mouse. Throws Error.
    explicit ExperimentHand(const std::string& choice);

    [[nodiscard]] Device& device() { return linked_ ? static_cast<Device&>(*linked_) : mouse_; }
    [[nodiscard]] std::string name() const { return linked_ ? linked_->name() : mouse_.name(); }
    [[nodiscard]] bool isMouse() const { return linked_ == nullptr; }
    [[nodiscard]] PadLimits pad() const { return linked_ ? linked_->pad() : PadLimits{}; }
    /// Null: a device is held.
    [[nodiscard]] MouseDevice* mouse() { return linked_ ? nullptr : &mouse_; }

  private:
    MouseDevice mouse_;
    std::unique_ptr<LinkedDevice> linked_;
};

} // namespace touchstone
