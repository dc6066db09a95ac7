#pragma once
// Materials to begin with. Numbers only: they bring no maps, and leave those that a material has.

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
    std::string_view reason;               ///< where the numbers come from
};

/// glass, wood, rubber, sandpaper, felt, ice.
[[nodiscard]] std::span<const MaterialPreset> materialPresets();
/// Null: there is none of that name.
[[nodiscard]] const MaterialPreset* findPreset(std::string_view name);

/// What is stated with the preset's numbers; those that say what holds anyway are left out.
[[nodiscard]] HapticStatement withPreset(HapticStatement statement, const MaterialPreset& preset);
/// The preset whose numbers these are; null: none.
[[nodiscard]] const MaterialPreset* presetOf(const HapticStatement& statement);

} // namespace touchstone
