#pragma once

#include "haptics/settings/haptic_settings.h"

namespace touchstone {

/// A further ShadingMode: two-pass shading with tactile shading's patch of normals in place of their
/// interpolation (shading/patch_normal.h). The setting's name after that of SingleRound.
inline constexpr ShadingMode kBezierShading{static_cast<uint8_t>(ShadingMode::SingleRound) + 1};

} // namespace touchstone
