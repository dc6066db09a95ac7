#pragma once
// Lives the ticks of a path and keeps what was felt.

#include "haptics/settings/haptic_settings.h"
#include "study/truth/truth_path.h"

#include <memory>

namespace touchstone::study {

struct FeltPath {
    std::vector<truth::FeltTick> ticks;
    int object = 0; ///< HapticScene::objects, touched in most ticks
    double facetAngle =
        0.0; ///< rad, mean over the changes from one facet to another that is not level with it
};

/// One tick a HIP, as the servo steps it, to the same bits. Calling thread; its float mode is the servo's.
[[nodiscard]] FeltPath feel(const HapticScene& scene, const HapticSettings& settings,
                            std::span<const glm::dvec3> hips);

} // namespace touchstone::study
