#include "devices/external/external_packet.h"

#include "devices/link/little_endian.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace touchstone {

namespace {

constexpr std::string_view kPlaceHead = "TSXP", kForceHead = "TSXF", kPadHead = "TSXD",
                           kLocationHead = "TSXL";
constexpr uint16_t kVersion = 1;
constexpr size_t kVersionAt = 4, kSizeAt = 6, kSequenceAt = 8, kWordAt = 12, kNumbersAt = 16;

double readDouble(std::span<const uint8_t> bytes, size_t index) {
    const size_t at = kNumbersAt + 8 * index;
    return std::bit_cast<double>(uint64_t{readU32(bytes, at)} | uint64_t{readU32(bytes, at + 4)} << 32);
}
void writeDouble(std::span<uint8_t> bytes, size_t index, double value) {
    const auto bits = std::bit_cast<uint64_t>(value);
    const size_t at = kNumbersAt + 8 * index;
    writeU32(bytes, at, static_cast<uint32_t>(bits));
    writeU32(bytes, at + 4, static_cast<uint32_t>(bits >> 32));
}
glm::dvec3 readVector(std::span<const uint8_t> bytes, size_t index) {
    return {readDouble(bytes, index), readDouble(bytes, index + 1), readDouble(bytes, index + 2)};
}
void writeVector(std::span<uint8_t> bytes, size_t index, const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i)
        writeDouble(bytes, index + static_cast<size_t>(i), v[i]);
}

bool wellFormed(std::span<const uint8_t> bytes, std::string_view head, size_t size) {
    return bytes.size() == size && std::equal(head.begin(), head.end(), bytes.begin()) &&
           readU16(bytes, kVersionAt) == kVersion && readU16(bytes, kSizeAt) == size;
}

template <size_t Size>
std::array<uint8_t, Size> begun(std::string_view head, uint32_t sequence, uint32_t word) {
    std::array<uint8_t, Size> bytes{};
    std::copy(head.begin(), head.end(), bytes.begin());
    writeU16(bytes, kVersionAt, kVersion);
    writeU16(bytes, kSizeAt, Size);
    writeU32(bytes, kSequenceAt, sequence);
    writeU32(bytes, kWordAt, word);
    return bytes;
}

bool within(const glm::dvec3& v, double most) { // false for NaN
    return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

} // namespace

std::optional<PlacePacket> parsePlacePacket(std::span<const uint8_t> bytes) {
    if (!wellFormed(bytes, kPlaceHead, kPlacePacketSize))
        return std::nullopt;
    PlacePacket packet{.sequence = readU32(bytes, kSequenceAt), .buttons = readU32(bytes, kWordAt)};
    packet.position = readVector(bytes, 0);
    const glm::dquat turn(readDouble(bytes, 3), readDouble(bytes, 4), readDouble(bytes, 5),
                          readDouble(bytes, 6));
    const double length = std::hypot(std::hypot(turn.w, turn.x), std::hypot(turn.y, turn.z));
    constexpr double kSlack = 0.01;
    if (!within(packet.position, kFarthestPlace) || !(length == 0.0 || std::abs(length - 1.0) < kSlack))
        return std::nullopt;
    if (length != 0.0)
        packet.orientation = turn / length;
    return packet;
}

std::optional<ForcePacket> parseForcePacket(std::span<const uint8_t> bytes) {
    if (!wellFormed(bytes, kForceHead, kForcePacketSize))
        return std::nullopt;
    return ForcePacket{readU32(bytes, kSequenceAt), readU32(bytes, kWordAt), readVector(bytes, 0),
                       readVector(bytes, 3)};
}

std::optional<PadPacket> parsePadPacket(std::span<const uint8_t> bytes) {
    if (!wellFormed(bytes, kPadHead, kPadPacketSize))
        return std::nullopt;
    const PadPacket packet{readU32(bytes, kSequenceAt), readDouble(bytes, 0), readDouble(bytes, 1)};
    const bool within = packet.reach >= 0.0 && packet.reach <= kLargestPad && packet.rate >= 0.0 &&
                        packet.rate <= kFastestPad;
    return within ? std::optional(packet) : std::nullopt; // NaN is not within
}

std::optional<LocationPacket> parseLocationPacket(std::span<const uint8_t> bytes) {
    if (!wellFormed(bytes, kLocationHead, kPadPacketSize))
        return std::nullopt;
    return LocationPacket{
        readU32(bytes, kSequenceAt), readU32(bytes, kWordAt), {readDouble(bytes, 0), readDouble(bytes, 1)}};
}

std::array<uint8_t, kPadPacketSize> padPacket(const PadPacket& packet) {
    auto bytes = begun<kPadPacketSize>(kPadHead, packet.sequence, 0);
    writeDouble(bytes, 0, packet.reach);
    writeDouble(bytes, 1, packet.rate);
    return bytes;
}

std::array<uint8_t, kPadPacketSize> locationPacket(const LocationPacket& packet) {
    auto bytes = begun<kPadPacketSize>(kLocationHead, packet.sequence, packet.answers);
    writeDouble(bytes, 0, packet.location.x);
    writeDouble(bytes, 1, packet.location.y);
    return bytes;
}

std::array<uint8_t, kPlacePacketSize> placePacket(const PlacePacket& packet) {
    auto bytes = begun<kPlacePacketSize>(kPlaceHead, packet.sequence, packet.buttons);
    writeVector(bytes, 0, packet.position);
    writeDouble(bytes, 3, packet.orientation.w);
    writeDouble(bytes, 4, packet.orientation.x);
    writeDouble(bytes, 5, packet.orientation.y);
    writeDouble(bytes, 6, packet.orientation.z);
    return bytes;
}

std::array<uint8_t, kForcePacketSize> forcePacket(const ForcePacket& packet) {
    auto bytes = begun<kForcePacketSize>(kForceHead, packet.sequence, packet.answers);
    writeVector(bytes, 0, packet.force);
    writeVector(bytes, 3, packet.torque);
    return bytes;
}

} // namespace touchstone
