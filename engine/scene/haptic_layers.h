#pragma once
// Of all that a file says about how a surface feels: what holds. Precedence is per field: our extension,
// MPEG's, KHR physics materials, then what the PBR material gives (docs/materials.md).

#include "engine/scene/image.h"
#include "engine/scene/material.h"

#include <optional>
#include <vector>

namespace touchstone {

/// Share of the static coefficient that is left while sliding, where the file gives only one value.
inline constexpr float kSlidingShare = 0.8f;

/// What the extensions give, without what is derived. Any thread.
[[nodiscard]] HapticMaterial statedHaptics(const HapticLayers& says);

/// Friction from the roughness that the file states, where no extension gave one:
///   mu_s = 0.15 + 0.6 roughness,  mu_d = kSlidingShare mu_s,
/// so a mirror feels like polished glass (0.15) and a fully rough surface like dry rubber on wood (0.75).
/// `meanRoughness` is the roughness factor times the texture's mean green; nothing derives nothing.
void deriveFriction(HapticMaterial& haptic, std::optional<float> meanRoughness);

/// What holds in the end: what is stated, without maps whose image is broken, and what is derived. The
/// importer and the editor make HapticMaterials by this alone, so that an edited scene feels as it will when
/// it is saved and opened again.
[[nodiscard]] HapticMaterial settledHaptics(const HapticLayers& says, const std::vector<Image>& images);

} // namespace touchstone
