#pragma once
// Which numbers the colours of a false-colour view stand for; for legends.

#include "engine/scene/scene.h"
#include "renderer/view.h"

#include <glm/glm.hpp>

#include <string_view>

namespace touchstone {

/// The ends of the colour scale. Surfaces for which the file states nothing are drawn grey.
struct FalseColorScale {
    double low = 0.0, high = 1.0;
    std::string_view unit;   ///< "m" (model metres), "N/m", "N·s/m", "1", or empty
    bool meaningful = false; ///< false: no material states this quantity, everything is grey
};

[[nodiscard]] FalseColorScale falseColorScale(const Scene& scene, ViewMode mode);

/// sRGB colour (0..1) of the scale at t in 0..1, as the shader draws it.
[[nodiscard]] glm::vec3 falseColor(double t);

} // namespace touchstone
