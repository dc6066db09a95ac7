#pragma once
// A servo that is stepped tick by tick, on one device.

#include "devices/device.h"
#include "engine/core/float_mode.h"
#include "haptics/servo/servo_loop.h"

#include <cstdint>

namespace touchstone::test {

[[nodiscard]] inline DevicePort portOf(Device& device) {
    return {
        .context = &device,
        .sample = [](void* context,
                     double time) noexcept { return static_cast<Device*>(context)->sample(time); },
        .apply = [](void* context,
                    const DeviceCommand& command) noexcept { static_cast<Device*>(context)->apply(command); },
        .feel = [](void* context,
                   const TouchFeedback& felt) noexcept { static_cast<Device*>(context)->feel(felt); }};
}

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

    [[nodiscard]] std::string name() const override { return "placed"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] DeviceSample sample(double) noexcept override { return next; }
    void apply(const DeviceCommand& given) noexcept override { command = given; }
};

} // namespace touchstone::test
