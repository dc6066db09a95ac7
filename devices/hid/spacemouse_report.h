#pragma once
// 3Dconnexion's SpaceMouse family: what its input reports say. Pure; no transport.

#include "devices/hid/report_bytes.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// What the last reports said. Raw axes as the cap stands on the desk: x right, y towards the user, z down;
/// then the turns about them. At rest all are zero, and a device at rest says nothing.
struct SpaceMouseState {
    std::array<int16_t, 6> axes{};
    uint32_t buttons = 0;
    bool operator==(const SpaceMouseState&) const = default;
};

/// Counts at full deflection. The cap gives about this; what is more is cut.
inline constexpr double kSpaceMouseFullScale = 350.0;

/// One report as hidraw gives it, its id first: 1 translation (or all six axes, on newer models), 2 rotation,
/// 3 buttons, each number int16 little endian. Other ids (23 is the battery) are ignored. What is malformed
/// changes nothing.
[[nodiscard]] ReportVerdict parseSpaceMouseReport(std::span<const uint8_t> report, SpaceMouseState& state);

/// How far the cap is pushed and turned, -1..1 on each axis, in the device frame (x right, y up, z towards
/// the user).
struct SpaceMouseDeflection {
    glm::dvec3 push{0.0}, turn{0.0};
};
[[nodiscard]] SpaceMouseDeflection deflectionOf(const SpaceMouseState& state);

} // namespace touchstone
