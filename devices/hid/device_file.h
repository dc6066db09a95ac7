#pragma once
// A device described by a file: protocol, kinematics and limits. docs/devices.md specifies the format.

#include "devices/hid/arm_kinematics.h"
#include "engine/device_io/device_io.h"
#include "engine/device_io/pad_command.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace touchstone {

enum class DeviceProtocol : uint8_t { WoodenHaptics, RawHid };

/// Identifies the HID node.
struct UsbMatch {
    uint16_t vendor = 0, product = 0;
    std::optional<int> interfaceNumber; ///< of a device with several interfaces
    std::string serial;                 ///< empty: any
};

struct DeviceFile {
    std::string name;
    DeviceProtocol protocol = DeviceProtocol::RawHid;
    UsbMatch usb;
    /// Absent where the firmware sends positions and takes forces.
    std::optional<ArmKinematics> arm;
    DeviceLimits limits;
    PadLimits pad; ///< raw HID
};

/// Reads and checks a device file. Throws Error with file, place in the file and remedy for: invalid JSON, an
/// unknown or missing key, a wrong type, a number out of range, a zero axis, a frame that is not a rotation.
[[nodiscard]] DeviceFile readDeviceFile(const std::filesystem::path& file);
/// The same from text; errors call it `name`.
[[nodiscard]] DeviceFile parseDeviceFile(std::string_view text, const std::string& name);

} // namespace touchstone
