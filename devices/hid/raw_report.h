#pragma once
// Touchstone's raw-HID protocol for self-built devices: 64 bytes each way, little endian, specified for
// firmware in docs/devices.md. Pure functions, no transport.

#include "devices/hid/report_bytes.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>

namespace touchstone {

inline constexpr size_t kRawReportSize = 64;
inline constexpr uint8_t kRawMagic = 0x54; ///< 'T'
inline constexpr uint8_t kRawVersion = 1;
inline constexpr uint8_t kRawState = 1, kRawForce = 2, kRawCurrent = 3; ///< byte 2: kind of report

/// Byte 3 of a state.
enum RawStateFlag : uint8_t {
    kRawCounts = 1 << 0,   ///< the axes are encoder counts, else the position in nm
    kRawHomed = 1 << 1,    ///< the axes are valid; else the sample is invalid
    kRawWatchdog = 1 << 2, ///< the firmware's watchdog has switched the motors off
    kRawFault = 1 << 3     ///< the device reports a fault and applies no force
};

/// Device to host.
struct RawState {
    uint8_t flags = 0;
    uint32_t sequence = 0;
    uint32_t deviceTimeUs = 0;
    uint32_t answered = 0; ///< sequence of the last command that the device accepted
    uint32_t buttons = 0;
    std::array<int32_t, 6> axes{}; ///< counts, or x, y, z in nm in the device frame and three zeros
};

/// Host to device. `values`: with kRawForce µN and µN·m in the device frame, with kRawCurrent µA per motor.
struct RawCommand {
    uint8_t kind = kRawForce;
    uint32_t sequence = 0;
    uint32_t answers = 0; ///< sequence of the state that the force answers
    uint16_t watchdogMs = 0;
    std::array<int32_t, 6> values{};
    std::array<int32_t, 2> location{}; ///< nm along and across the pad; zeros for a device without a display
};

/// Requires exactly 64 bytes with valid magic, version, kind and checksum; else nullopt.
[[nodiscard]] std::optional<RawState> parseRawState(std::span<const uint8_t> report);
/// The firmware's direction, for simulators and tests.
[[nodiscard]] std::optional<RawCommand> parseRawCommand(std::span<const uint8_t> report);

[[nodiscard]] std::array<uint8_t, kRawReportSize> rawState(const RawState& state);
[[nodiscard]] std::array<uint8_t, kRawReportSize> rawCommand(const RawCommand& command);

/// CRC-32 as in Ethernet and zip (polynomial 0xEDB88320 reflected, initial value and final XOR all ones).
[[nodiscard]] uint32_t crc32(std::span<const uint8_t> bytes);

} // namespace touchstone
