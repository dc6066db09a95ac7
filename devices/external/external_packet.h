#pragma once
// What a device that is another program sends and hears: two packets, little endian. docs/devices.md
// describes them for those who write such programs. Pure; no transport.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace touchstone {

inline constexpr size_t kPlacePacketSize = 72, kForcePacketSize = 64;

/// Client to Touchstone: where the hand is, in the device frame (m; x right, y up, z towards the user).
struct PlacePacket {
    uint32_t sequence = 0;
    uint32_t buttons = 0;
    glm::dvec3 position{0.0};
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0}; ///< unit; sent as w, x, y, z, four zeros stand for no turn
};

/// Touchstone to client: what the hand shall feel.
struct ForcePacket {
    uint32_t sequence = 0;
    uint32_t answers = 0;   ///< sequence of the newest place
    glm::dvec3 force{0.0};  ///< N
    glm::dvec3 torque{0.0}; ///< N·m
};

/// Exactly so many bytes, with the right head, and numbers that can be a place: finite, within
/// kFarthestPlace, a turn of about unit length. Else nothing.
[[nodiscard]] std::optional<PlacePacket> parsePlacePacket(std::span<const uint8_t> bytes);
[[nodiscard]] std::optional<ForcePacket> parseForcePacket(std::span<const uint8_t> bytes);

[[nodiscard]] std::array<uint8_t, kPlacePacketSize> placePacket(const PlacePacket& packet);
[[nodiscard]] std::array<uint8_t, kForcePacketSize> forcePacket(const ForcePacket& packet);

/// m; no workspace is larger, and a client that means millimetres is found out.
inline constexpr double kFarthestPlace = 10.0;

} // namespace touchstone
