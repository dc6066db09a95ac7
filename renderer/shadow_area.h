#pragma once
// Where in a picture the probe's shadow is seen. Pure arithmetic.

#include "renderer/view.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Pixels from `low` to below `high`, from the upper left corner.
struct PixelArea {
    glm::ivec2 low{0}, high{0};
    [[nodiscard]] bool empty() const { return low.x >= high.x || low.y >= high.y; }
};

/// Outside of it leftByProbe (shaders/probe_shadow.glsl) takes less than kUnseen of the first light and of
/// the surroundings. Within `size` pixels; empty without a probe.
inline constexpr double kUnseen = 1.0 / 256.0;
[[nodiscard]] PixelArea shadowArea(const View& view, const glm::ivec2& size);

} // namespace touchstone
