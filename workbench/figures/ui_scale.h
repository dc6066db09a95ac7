#pragma once
// The size of type and widgets: the monitor's content scale times the user's UI scale, as far as it fits.

#include <glm/glm.hpp>

#include <string>
#include <string_view>

namespace touchstone {

/// Of the user's UI scale. At the smallest one type is 11 pixels high.
inline constexpr float kMinUiScale = 0.75f, kMaxUiScale = 4.0f;
/// Layout units that the window always has: larger scales do not fit.
inline constexpr glm::vec2 kMinLayout{640.0f, 400.0f};

/// Window coordinates per layout unit: `monitor` (its content scale) times `wanted`, but in steps no larger
/// than leaves kMinLayout in a window of `window` coordinates, and never below kMinUiScale. Any arguments.
[[nodiscard]] float fittingScale(float wanted, float monitor, const glm::vec2& window);

/// The next multiple of a quarter above (`direction` 1) or below (-1) `scale`, within the limits.
[[nodiscard]] float steppedUiScale(float scale, int direction);

/// `scale` within the limits; 1 where it is no number.
[[nodiscard]] float clampedUiScale(double scale);

/// Reads a number within the limits. Returns the problem; empty: none.
[[nodiscard]] std::string readUiScale(std::string_view text, float& scale);

} // namespace touchstone
