#include "workbench/figures/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace touchstone {

namespace {

/// From `from` on, numbers of `unit` are shown in `shown`.
struct Prefix {
    std::string_view unit;
    double from;
    ShownUnit shown;
};

// Of each unit the largest first; the last one takes all that is smaller.
constexpr std::array kPrefixes{
    Prefix{"m", 1.0, {1.0, "m"}},        Prefix{"m", 1e-3, {1e-3, "mm"}},    Prefix{"m", 1e-6, {1e-6, "µm"}},
    Prefix{"m", 0.0, {1e-9, "nm"}},      Prefix{"s", 1.0, {1.0, "s"}},       Prefix{"s", 1e-3, {1e-3, "ms"}},
    Prefix{"s", 1e-6, {1e-6, "µs"}},     Prefix{"s", 0.0, {1e-9, "ns"}},     Prefix{"m/s", 1.0, {1.0, "m/s"}},
    Prefix{"m/s", 1e-3, {1e-3, "mm/s"}}, Prefix{"m/s", 0.0, {1e-6, "µm/s"}}, Prefix{"N", 0.01, {1.0, "N"}},
    Prefix{"N", 0.0, {1e-3, "mN"}},      Prefix{"J", 1.0, {1.0, "J"}},       Prefix{"J", 1e-4, {1e-3, "mJ"}},
    Prefix{"J", 0.0, {1e-6, "µJ"}},      Prefix{"1", 0.0, {1.0, ""}},
};
constexpr double kOfZero = 1e-3; ///< zero is shown in the unit of this number: 0 mm

/// The whole digits of `text` ("-12345.6") in groups of three.
void separateThousands(std::string& text) {
    const size_t begin = text.starts_with('-') ? 1 : 0;
    const size_t point = std::min(text.find('.'), text.size());
    for (size_t at = point; at > begin + 3;) {
        at -= 3;
        text.insert(at, ",");
    }
}

} // namespace

ShownUnit shownUnit(double largest, std::string_view unit) {
    const double magnitude = largest == 0.0 ? kOfZero : std::abs(largest);
    for (const Prefix& prefix : kPrefixes)
        // 0.9999 mm with three digits is 1 mm, not 1,000 µm.
        if (prefix.unit == unit && magnitude >= 0.9995 * prefix.from)
            return prefix.shown;
    return {1.0, unit};
}

std::string figure(double value, int digits) {
    char text[64];
    constexpr double kLargest = 1e12;
    if (!std::isfinite(value) || std::abs(value) >= kLargest) {
        std::snprintf(text, sizeof text, "%.*g", digits, value);
        return text;
    }
    constexpr int kMostDecimals = 9;
    const int magnitude = value == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
    const int decimals = std::clamp(digits - 1 - magnitude, 0, kMostDecimals);
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    std::string shown = text;
    if (decimals > 0) {
        shown.erase(shown.find_last_not_of('0') + 1);
        if (shown.ends_with('.'))
            shown.pop_back();
    }
    if (shown == "-0")
        shown = "0";
    separateThousands(shown);
    return shown;
}

std::string quantity(double value, const ShownUnit& unit, int digits) {
    const bool beside = unit.text.empty() || unit.text == "°" || unit.text == "x";
    return figure(value / unit.size, digits) + (beside ? "" : " ") + std::string(unit.text);
}

std::string quantity(double value, std::string_view unit, int digits) {
    return quantity(value, shownUnit(value, unit), digits);
}

} // namespace touchstone
