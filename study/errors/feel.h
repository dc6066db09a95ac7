#pragma once
// Runs the ticks of a path and records the result.

#include "haptics/settings/haptic_settings.h"
#include "study/truth/truth_path.h"

#include <memory>

namespace touchstone::study {

struct FeltPath {
    std::vector<truth::FeltTick> ticks;
    int object = 0;          ///< HapticScene::objects, touched in the most ticks
    double facetAngle = 0.0; ///< rad, mean over the changes between facets that are not coplanar
};

/// One tick per HIP, bitwise equal to the servo's. Calling thread, in the servo's float mode.
[[nodiscard]] FeltPath feel(const HapticScene& scene, const HapticSettings& settings,
                            std::span<const glm::dvec3> hips);

} // namespace touchstone::study
