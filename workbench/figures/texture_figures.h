#pragma once
// What touch has changed of persistent textures, for JSON.

#include "haptics/scene/haptic_scene.h"
#include "haptics/texture/persistent_textures.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// One entry for each object with a texture; null where `textures` is.
[[nodiscard]] nlohmann::ordered_json texturesJson(const HapticScene& scene,
                                                  const PersistentTextures* textures);

} // namespace touchstone
