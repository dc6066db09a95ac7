#pragma once
// Selection of the Vulkan device. Pure, so that tests cover machines with many devices.

#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

enum class DeviceKind { Discrete, Integrated, Virtual, Software, Other };

struct DeviceCandidate {
    std::string name;
    DeviceKind kind = DeviceKind::Other;
    std::string unfit; ///< empty, or why it is not usable
};

/// Index of the device to use: the one that `wanted` names (part of its name, case-insensitive, or its
/// index), else the usable one of the best kind, the first among equals. Throws Error with the list of
/// devices when there is none.
[[nodiscard]] size_t chooseDevice(const std::vector<DeviceCandidate>& candidates, std::string_view wanted);

/// "0: llvmpipe (software)", with the reason if it is not usable.
[[nodiscard]] std::string describeCandidate(size_t index, const DeviceCandidate& candidate);

} // namespace touchstone
