#pragma once
// Which of the Vulkan devices to take. Pure, so that machines with many devices can be tested on one with
// none.

#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

enum class DeviceKind { Discrete, Integrated, Virtual, Software, Other };

struct DeviceCandidate {
    std::string name;
    DeviceKind kind = DeviceKind::Other;
    std::string unfit; ///< empty, or why it cannot be used
};

/// Index of the device to use: the one that `wanted` names (part of its name in any case, or its index), else
/// the fit one of the best kind, the first among equals. Throws Error when there is none, saying what was
/// found.
[[nodiscard]] size_t chooseDevice(const std::vector<DeviceCandidate>& candidates, std::string_view wanted);

/// "0: llvmpipe (software)", with the reason if it is unfit.
[[nodiscard]] std::string describeCandidate(size_t index, const DeviceCandidate& candidate);

} // namespace touchstone
