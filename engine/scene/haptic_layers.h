#pragma once
// Resolves a file's statements about how a surface feels. Precedence is per field: the project's extension,
// MPEG's, KHR physics materials, then values derived from the PBR material (docs/materials.md).

#include "engine/scene/image.h"
#include "engine/scene/material.h"

#include <optional>
#include <vector>

namespace touchstone {

/// Dynamic over static coefficient, where the file states only one.
inline constexpr float kSlidingShare = 0.8f;

/// The values that the extensions state, without derived ones. Any thread.
[[nodiscard]] HapticMaterial statedHaptics(const HapticLayers& says);

/// Friction from the roughness that the file states, where no extension states one:
///   mu_s = 0.15 + 0.6 roughness,  mu_d = kSlidingShare mu_s,
/// so a mirror feels like polished glass (0.15) and a fully rough surface like dry rubber on wood (0.75).
/// `meanRoughness` is the roughness factor times the texture's mean green; empty: no friction is derived.
void deriveFriction(HapticMaterial& haptic, std::optional<float> meanRoughness);

/// The final properties: stated values, without maps whose image is broken, and derived ones. Importer and
/// editor make every HapticMaterial with this function, so that an edited scene feels the same after it is
/// saved and opened again.
[[nodiscard]] HapticMaterial settledHaptics(const HapticLayers& says, const std::vector<Image>& images);

} // namespace touchstone
