#pragma once

#include "haptics/settings/effect_plan.h"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace touchstone {

/// Classifies materials: one colour for each set of effects in some material's plan.
struct EffectColors {
    struct Kind {
        std::string effects; ///< "force shading, friction"
        glm::vec3 color;     ///< sRGB, 0..1
    };
    std::vector<Kind> kinds;          ///< plain materials first, then by number of effects
    std::vector<glm::vec3> materials; ///< the colour of each material, sRGB
};

/// Pure. Kinds beyond the number of colours (8) share the last one.
[[nodiscard]] EffectColors effectColors(const EffectPlan& plan, size_t materials);

} // namespace touchstone
