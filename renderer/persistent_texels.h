#pragma once

#include <cstdint>

namespace touchstone {

/// A rectangle of the persistent texture of an instance.
struct PersistentTexels {
    int instance = -1; ///< Scene::instances
    uint32_t textureWidth = 0, textureHeight = 0;
    uint32_t x = 0, y = 0, width = 0, height = 0; ///< texels
    const float* values = nullptr;                ///< of its first texel; a row is textureWidth further
};

} // namespace touchstone
