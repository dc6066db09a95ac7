#pragma once

#include "devices/device/device.h"
#include "haptics/servo/planar_servo.h"
#include "haptics/servo/servo_loop.h"

namespace touchstone {

/// Connects a device to the servo; the device outlives the loop.
[[nodiscard]] inline DevicePort portOf(Device& device) {
    return {
        .context = &device,
        .sample = [](void* context,
                     double time) noexcept { return sampleWithLimits(*static_cast<Device*>(context), time); },
        .apply = [](void* context,
                    const DeviceCommand& command) noexcept { static_cast<Device*>(context)->apply(command); },
        .feel = [](void* context,
                   const TouchFeedback& felt) noexcept { static_cast<Device*>(context)->feel(felt); }};
}

/// Its contact location display, likewise.
[[nodiscard]] inline PadPort padPortOf(Device& device) {
    return {.context = &device,
            .limits = [](void* context) noexcept { return static_cast<Device*>(context)->pad(); },
            .apply =
                [](void* context, const PadCommand& command) noexcept {
                    static_cast<Device*>(context)->applyPad(command);
                }};
}

} // namespace touchstone
