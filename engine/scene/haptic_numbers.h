#pragma once
// The numbers of TOUCHSTONE_materials_haptic: one row each, from which the import, the layers, `inspect`,
// `edit` and the window's panel are made. Not for the servo thread.

#include "engine/scene/material.h"

#include <span>
#include <string_view>

namespace touchstone {

/// Larger values are out of any unit's range.
inline constexpr float kLargestHapticNumber = 1e30f;

/// How a number of a material is named, bounded and shown.
struct HapticNumberText {
    std::string_view name, label, unit;
    float least, most;      ///< range of the extension, SI
    float low, high;        ///< ends of a slider; a value beyond them can be typed
    bool logarithmic;       ///< slider
    std::string_view unset; ///< effective value where it is not stated
    std::string_view meaning;
};

/// A number of a material: its member of a statement, and its settled form. `settled` is null for a number
/// that chooses the object's shape and is no property of the surface.
struct HapticNumber : HapticNumberText {
    std::optional<float> HapticStatement::*stated;
    HapticMaterial::Field<float> HapticMaterial::*settled;
};
[[nodiscard]] std::span<const HapticNumber> hapticNumbers();
/// Null: no such number.
[[nodiscard]] const HapticNumber* findHapticNumber(std::string_view name);

} // namespace touchstone
