#pragma once
// The packets of a device that is another program, little endian; docs/devices.md specifies them. Pure
// functions, no transport.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace touchstone {

inline constexpr size_t kPlacePacketSize = 72, kForcePacketSize = 64, kPadPacketSize = 32;

/// Client to Touchstone: position of the hand in the device frame (m; x right, y up, z towards the user).
struct PlacePacket {
    uint32_t sequence = 0;
    uint32_t buttons = 0;
    glm::dvec3 position{0.0};
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0}; ///< unit; sent as w, x, y, z; four zeros: no rotation
};

/// Touchstone to client: the force to render.
struct ForcePacket {
    uint32_t sequence = 0;
    uint32_t answers = 0;   ///< sequence of the latest position
    glm::dvec3 force{0.0};  ///< N
    glm::dvec3 torque{0.0}; ///< N·m
};

/// Client to Touchstone: it has a contact location display. Once, after its first position.
struct PadPacket {
    uint32_t sequence = 0;
    double reach = 0.0; ///< m from the middle of the pad, 0 (none any more) to kLargestPad
    double rate = 0.0;  ///< m/s, up to kFastestPad
};

/// Touchstone to a client with such a display: what it shows. After each force.
struct LocationPacket {
    uint32_t sequence = 0; ///< that of the force
    uint32_t answers = 0;
    glm::dvec2 location{0.0}; ///< m along and across the pad
};

inline constexpr double kLargestPad = 0.1;   ///< m
inline constexpr double kFastestPad = 100.0; ///< m/s

/// Parses a packet of exactly the specified size with a valid header, finite positions within kFarthestPlace
/// and an orientation of about unit length. Else nullopt.
[[nodiscard]] std::optional<PlacePacket> parsePlacePacket(std::span<const uint8_t> bytes);
[[nodiscard]] std::optional<ForcePacket> parseForcePacket(std::span<const uint8_t> bytes);

/// Likewise; nullopt also where a number lies beyond its range.
[[nodiscard]] std::optional<PadPacket> parsePadPacket(std::span<const uint8_t> bytes);
[[nodiscard]] std::optional<LocationPacket> parseLocationPacket(std::span<const uint8_t> bytes);
[[nodiscard]] std::array<uint8_t, kPadPacketSize> padPacket(const PadPacket& packet);
[[nodiscard]] std::array<uint8_t, kPadPacketSize> locationPacket(const LocationPacket& packet);

[[nodiscard]] std::array<uint8_t, kPlacePacketSize> placePacket(const PlacePacket& packet);
[[nodiscard]] std::array<uint8_t, kForcePacketSize> forcePacket(const ForcePacket& packet);

/// m; larger than any workspace. Positions beyond it reveal a client that sends millimetres.
inline constexpr double kFarthestPlace = 10.0;

} // namespace touchstone
