#pragma once
// Numbers for people: unit prefixes, separated thousands, no exponents.

#include <string>
#include <string_view>

namespace touchstone {

/// A unit in which numbers of one magnitude are shown, and its size in the SI unit.
struct ShownUnit {
    double size = 1.0;
    std::string_view text;
};

/// The unit for numbers up to `largest` (SI) of the SI unit `unit`: 0.0005 m in µm, 0.02 m in mm. A scale
/// asks once, with its largest number, so that all its labels have the same unit. A unit without prefixes
/// (N/m) stays.
[[nodiscard]] ShownUnit shownUnit(double largest, std::string_view unit);

/// `digits` significant digits without trailing zeros, thousands separated: "0.125", "2,000", "64,800". Whole
/// digits are never rounded away. From 1e12 on with an exponent.
[[nodiscard]] std::string figure(double value, int digits = 3);

/// `value` (SI) with its unit: "2,000 N/m", "0.5 mm", "12 µm/s", "30°"; without a unit the figure alone.
[[nodiscard]] std::string quantity(double value, std::string_view unit, int digits = 3);
/// The same in a given unit.
[[nodiscard]] std::string quantity(double value, const ShownUnit& unit, int digits = 3);

} // namespace touchstone
