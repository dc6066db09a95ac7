#pragma once

#include "engine/device_io/device_io.h"
#include "engine/device_io/pad_command.h"

#include <string>

namespace touchstone {

/// A device measures a position and may apply a force. `sample` and `apply` are called on the servo thread:
/// they must not block, allocate, lock or throw (a device whose I/O blocks keeps its own thread and mailbox).
class Device {
  public:
    virtual ~Device() = default;
    [[nodiscard]] virtual std::string name() const = 0; ///< owner thread
    /// Of the device that gets the next command: servo thread, after `sample`, or owner thread while the
    /// servo does not run. No allocation or lock.
    [[nodiscard]] virtual DeviceLimits limits() const = 0;
    /// Servo thread, before each sample. Only needed by devices whose position the program computes.
    virtual void feel(const TouchFeedback& felt) noexcept { (void)felt; }
    /// Servo thread; time in s since start. Without limits: see sampleWithLimits.
    [[nodiscard]] virtual DeviceSample sample(double time) noexcept = 0;
    virtual void apply(const DeviceCommand& command) noexcept = 0; ///< servo thread
    /// Servo thread, after `sample`: of its contact location display; none by default.
    [[nodiscard]] virtual PadLimits pad() const noexcept { return {}; }
    /// Servo thread, before `apply`, where pad() has a reach.
    virtual void applyPad(const PadCommand& command) noexcept { (void)command; }
};

/// The input of a tick: the device's sample with the limits that its command must keep. Servo thread.
[[nodiscard]] inline DeviceSample sampleWithLimits(Device& device, double time) noexcept {
    DeviceSample sample = device.sample(time);
    sample.limits = device.limits();
    return sample;
}

} // namespace touchstone
