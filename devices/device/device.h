#pragma once

#include "engine/device_io/device_io.h"

#include <string>

namespace touchstone {

/// A device measures a position and may apply a force. `sample` and `apply` are called on the servo thread:
/// they must not block, allocate, lock or throw (a device whose I/O blocks keeps its own thread and mailbox).
class Device {
  public:
    virtual ~Device() = default;
    [[nodiscard]] virtual std::string name() const = 0;    ///< owner thread
    [[nodiscard]] virtual DeviceLimits limits() const = 0; ///< owner thread
    /// Servo thread, before each sample. Only needed by devices whose position the program computes.
    virtual void feel(const TouchFeedback& felt) noexcept { (void)felt; }
    [[nodiscard]] virtual DeviceSample
    sample(double time) noexcept = 0;                              ///< servo thread; time in s since start
    virtual void apply(const DeviceCommand& command) noexcept = 0; ///< servo thread
};

} // namespace touchstone
