#pragma once
// A device described by a file: what it speaks, how it is built, what it may be given. docs/devices.md
// describes the format.

#include "devices/hid/arm_kinematics.h"
#include "engine/device_io/device_io.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace touchstone {

enum class DeviceProtocol : uint8_t { WoodenHaptics, RawHid };

/// Which HID node it is.
struct UsbMatch {
    uint16_t vendor = 0, product = 0;
    std::optional<int> interfaceNumber; ///< of a device with several
    std::string serial;                 ///< empty: any
};

struct DeviceFile {
    std::string name;
    DeviceProtocol protocol = DeviceProtocol::RawHid;
    UsbMatch usb;
    /// Absent where the firmware sends positions and takes forces.
    std::optional<ArmKinematics> arm;
    DeviceLimits limits;
};

/// Reads and checks a device file. Throws Error that names the file, the place in it and the remedy: no JSON,
/// an unknown or missing key, a wrong type, a number out of its range, an axis without length, a frame that
/// is no rotation.
[[nodiscard]] DeviceFile readDeviceFile(const std::filesystem::path& file);
/// The same from text; `name` is what errors call it.
[[nodiscard]] DeviceFile parseDeviceFile(std::string_view text, const std::string& name);

} // namespace touchstone
