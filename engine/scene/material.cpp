#include "engine/scene/material.h"

#include <cmath>

namespace touchstone {

glm::vec2 TextureRef::transform(const glm::vec2& uv) const {
    // KHR_texture_transform: scale, then rotate counter-clockwise as seen in the image (v points down), then
    // move.
    const float c = std::cos(rotation), s = std::sin(rotation);
    const glm::vec2 scaled = scale * uv;
    return offset + glm::vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
}

} // namespace touchstone
