#pragma once

#include "haptics/scene/haptic_scene.h"
#include "workbench/screen/effect_colors.h"

#include <vector>

namespace touchstone {

/// The legend of ViewMode::Perception: a line for each angle of [004], largest first, with its rendering and
/// the number of edges beyond it. Counts the scene's edges; linear in its triangles.
[[nodiscard]] std::vector<EffectColors::Kind> feltColors(const HapticScene& scene);

} // namespace touchstone
