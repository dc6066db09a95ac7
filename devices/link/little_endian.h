#pragma once
// Little-endian numbers in packets, and sequence numbers. The caller checks the length.

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchstone {

[[nodiscard]] inline uint16_t readU16(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<uint16_t>(bytes[at] | bytes[at + 1] << 8);
}
[[nodiscard]] inline int16_t readI16(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<int16_t>(readU16(bytes, at));
}
[[nodiscard]] inline uint32_t readU32(std::span<const uint8_t> bytes, size_t at) {
    return uint32_t{readU16(bytes, at)} | uint32_t{readU16(bytes, at + 2)} << 16;
}
[[nodiscard]] inline int32_t readI32(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<int32_t>(readU32(bytes, at));
}

inline void writeU16(std::span<uint8_t> bytes, size_t at, uint16_t value) {
    bytes[at] = static_cast<uint8_t>(value);
    bytes[at + 1] = static_cast<uint8_t>(value >> 8);
}
inline void writeU32(std::span<uint8_t> bytes, size_t at, uint32_t value) {
    writeU16(bytes, at, static_cast<uint16_t>(value));
    writeU16(bytes, at + 2, static_cast<uint16_t>(value >> 16));
}

/// Interpretation of a sequence number. A counter that jumps far back belongs to a restarted device.
struct SequenceStep {
    bool fresh = true;
    uint32_t lost = 0; ///< missing numbers
};
/// Farther back than reports can be in flight: a restart, not a packet out of order.
inline constexpr uint32_t kSequenceRestart = 1000;

[[nodiscard]] inline SequenceStep sequenceStep(uint32_t last, uint32_t now) {
    const uint32_t forward = now - last; // modulo 2^32, as counters wrap
    if (forward == 0 || -forward < kSequenceRestart)
        return {.fresh = false};
    const bool restarted = forward > UINT32_MAX / 2;
    return {.fresh = true, .lost = restarted ? 0 : forward - 1};
}

} // namespace touchstone
