#pragma once
// What the charts can show, as strips, as columns of the CSV and as curves of the figure.

#include "workbench/readings/force_history.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace touchstone {

struct ChartQuantity {
    const char* name;   ///< "normal": in the window, in window.json and in the status
    const char* words;  ///< "normal force"
    const char* symbol; ///< its unit, "mm"
    double unit;        ///< SI units in one of it
    float ForceHistory::Entry::*value;
    double minEnd;  ///< smallest end of the scale, in `symbol`
    bool positive;  ///< the scale begins at zero; otherwise it is symmetric about zero
    uint32_t color; ///< sRGB, 0xrrggbb, on a dark ground
    const char* explanation;
};

inline constexpr size_t kChartQuantityCount = 9;
/// In the order in which they are shown; forces first.
[[nodiscard]] std::span<const ChartQuantity, kChartQuantityCount> chartQuantities();

/// By index into chartQuantities. At first what separates the effects: shading, texture and friction turn the
/// force and hardly change its magnitude where the hand presses with a given force, as the mouse does.
using ShownQuantities = std::array<bool, kChartQuantityCount>;
inline constexpr ShownQuantities kFirstQuantities{true, true, false, false, false, false, true, false, false};

} // namespace touchstone
