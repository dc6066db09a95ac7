#pragma once
// Material presets. Numbers only: they leave a material's maps unchanged.

#include "engine/scene/material.h"

#include <span>
#include <string_view>

namespace touchstone {

struct MaterialPreset {
    std::string_view name;
    float stiffness;                       ///< N/m
    float damping;                         ///< N·s/m; 0: none
    float staticFriction, dynamicFriction; ///< 1
    float viscousFriction;                 ///< N·s/m; 0: none
    float normalTextureInfluence;          ///< 0..1
    std::string_view reason;               ///< source of the numbers
};

/// glass, wood, rubber, sandpaper, felt, ice.
[[nodiscard]] std::span<const MaterialPreset> materialPresets();
/// Null for an unknown name.
[[nodiscard]] const MaterialPreset* findPreset(std::string_view name);

/// The statement with the preset's numbers; values equal to the defaults are omitted.
[[nodiscard]] HapticStatement withPreset(HapticStatement statement, const MaterialPreset& preset);
/// The preset with these numbers; null: none.
[[nodiscard]] const MaterialPreset* presetOf(const HapticStatement& statement);

} // namespace touchstone
