#pragma once
// Input reports of 3Dconnexion's SpaceMouse family. Pure functions, no transport.

#include "devices/hid/report_bytes.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// State after the last reports. Raw axes as the cap stands on the desk: x right, y towards the user, z down;
/// then the rotations about them. At rest all are zero and the device sends nothing.
struct SpaceMouseState {
    std::array<int16_t, 6> axes{};
    uint32_t buttons = 0;
    bool operator==(const SpaceMouseState&) const = default;
};

/// Counts at full deflection, approximately; larger values are clamped.
inline constexpr double kSpaceMouseFullScale = 350.0;

/// Parses one report as hidraw delivers it, its id first: 1 translation (or all six axes, on newer models), 2
/// rotation, 3 buttons, each number int16 little endian. Other ids (23 is the battery) are ignored. A
/// malformed report changes nothing.
[[nodiscard]] ReportVerdict parseSpaceMouseReport(std::span<const uint8_t> report, SpaceMouseState& state);

/// Deflection of the cap, -1..1 on each axis, in the device frame (x right, y up, z towards the user).
struct SpaceMouseDeflection {
    glm::dvec3 push{0.0}, turn{0.0};
};
[[nodiscard]] SpaceMouseDeflection deflectionOf(const SpaceMouseState& state);

} // namespace touchstone
