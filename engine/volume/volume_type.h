#pragma once

#include <cstdint>

namespace touchstone {

/// Types in which values of a volume are kept. Wider integers and doubles become Float.
enum class VolumeType : uint32_t { UInt8, Int8, UInt16, Int16, Float };
inline constexpr uint32_t kVolumeTypes = 5;

[[nodiscard]] constexpr uint32_t bytesOf(VolumeType type) {
    return type == VolumeType::Float ? 4 : type == VolumeType::UInt8 || type == VolumeType::Int8 ? 1 : 2;
}

} // namespace touchstone
