#pragma once
// Feels a stroke with the whole haptic step, offline: how deep, how long, how fast.

#include "devices/stroke/stroke_path.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"

#include <string>

namespace touchstone::test {

/// One or more periods of a stroke on the bare surface: point proxy, no texture, friction or shading.
struct FeltStroke {
    int ticks = 0, contact = 0;
    bool began = false;                         ///< in contact in the first tick
    bool inside = false;                        ///< ever began inside a body, where nothing is felt
    double insideAt = 0.0;                      ///< s, the first time
    double deepest = 0.0, deepestAt = 0.0;      ///< m, |proxy - HIP|; s
    double fastest = 0.0, fastestInTouch = 0.0; ///< m/s
    double jerkiest = 0.0;                      ///< m/s²
};

/// `source` keeps the animation; null: everything rests. `periods` of the stroke at 1 kHz.
[[nodiscard]] FeltStroke feel(const HapticScene& scene, const StrokePath& path, ScenePtr source = nullptr,
                              int periods = 1);

} // namespace touchstone::test
