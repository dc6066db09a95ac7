#pragma once
// A servo that is stepped tick by tick, on one device.

#include "engine/core/float_mode.h"
#include "session/device_port.h"

#include <cstdint>

namespace touchstone::test {

struct SteppedServo {
    explicit SteppedServo(Device& device) : loop(portOf(device)) { enterFloatMode(); }

    const TickRecord& step() {
        record = loop.step(next++);
        TickRecord ignored;
        while (loop.popRecord(ignored)) {
        }
        TouchCheckpoint checkpoint;
        while (loop.popCheckpoint(checkpoint)) {
        }
        (void)loop.updateSnapshot();
        return record;
    }

    ServoLoop loop;
    TickRecord record; ///< of the last tick
    uint64_t next = 0;
};

/// A device that is where the test puts it.
struct PlacedDevice final : Device {
    DeviceSample next;
    DeviceCommand command;
    DeviceLimits own;

    [[nodiscard]] std::string name() const override { return "placed"; }
    [[nodiscard]] DeviceLimits limits() const override { return own; }
    [[nodiscard]] DeviceSample sample(double) noexcept override { return next; }
    void apply(const DeviceCommand& given) noexcept override { command = given; }
};

} // namespace touchstone::test
