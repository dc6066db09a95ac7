#pragma once
// What touch has changed of persistent textures, for people and for JSON.

#include "haptics/scene/haptic_scene.h"
#include "haptics/texture/persistent_textures.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace touchstone {

/// How much of an object is covered, where a texture's minimum is bare and its maximum covered.
struct Coverage {
    int object = 0;       ///< HapticScene::objects
    double left = 0.0;    ///< 0 to 1, of the area
    double removed = 0.0; ///< of the area, since the texture had its initial value; negative: added
    double areaM2 = 0.0;  ///< of the object's surface; model metres
};

/// Of each object with a texture; empty where `textures` is null.
[[nodiscard]] std::vector<Coverage> coverageOf(const HapticScene& scene, const PersistentTextures* textures);

/// "coverage 91.1 %, 8.9 % removed (3.21 cm^2)".
[[nodiscard]] std::string coverageText(const Coverage& coverage);

/// One entry for each object with a texture; null where `textures` is.
[[nodiscard]] nlohmann::ordered_json texturesJson(const HapticScene& scene,
                                                  const PersistentTextures* textures);

/// Prints a line for each.
void printCoverage(const HapticScene& scene, const PersistentTextures* textures);

} // namespace touchstone
