#pragma once

#include "devices/device/device.h"
#include "haptics/servo/servo_loop.h"

namespace touchstone {

/// Connects a device and its contact location display to the servo; the device outlives the loop.
[[nodiscard]] inline DevicePort portOf(Device& device) {
    return {
        .context = &device,
        .sample = [](void* context,
                     double time) noexcept { return sampleWithLimits(*static_cast<Device*>(context), time); },
        .apply = [](void* context,
                    const DeviceCommand& command) noexcept { static_cast<Device*>(context)->apply(command); },
        .feel = [](void* context,
                   const TouchFeedback& felt) noexcept { static_cast<Device*>(context)->feel(felt); },
        .pad = [](void* context) noexcept { return static_cast<Device*>(context)->pad(); },
        .applyPad =
            [](void* context, const PadCommand& command) noexcept {
                static_cast<Device*>(context)->applyPad(command);
            }};
}

} // namespace touchstone
