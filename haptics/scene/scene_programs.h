#pragma once
// Haptic programs of a compiled scene.

#include "engine/scene/scene.h"
#include "haptics/program/felt_program.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/texture/persistent_textures.h"

#include <cstddef>
#include <memory>

namespace touchstone {

/// Gives material `index` of `haptic` the program of `material`, with a warning where the executor does not
/// accept it, or what the file has of its persistent textures is damaged. `source`: of the instances.
/// `before`: that of the material before an edit; may be null. Not for the servo.
void addProgram(const Scene& source, const Material& material, size_t index,
                const program::FeltProgram* before, HapticScene& haptic);

/// Fills HapticScene::programFromObject where some material has a program. `source`: what it was compiled
/// from.
void placePrograms(const Scene& source, HapticScene& haptic);

/// Fills HapticScene::texels where a material has a persistent texture, with a warning for an object that has
/// no texture coordinates. Those of `before` (a scene of the same objects; may be null) are shared where they
/// fit. Throws Cancelled.
void placeTexels(const HapticScene* before, HapticScene& haptic, const Progress& progress = {});

/// The textures of a world that begins on `haptic`; null where no object has one. `goOn`: those of a scene of
/// the same geometry, which are returned where they fit. Not for the servo.
[[nodiscard]] std::shared_ptr<PersistentTextures>
persistentTextures(const HapticScene& haptic, std::shared_ptr<PersistentTextures> goOn = nullptr);

} // namespace touchstone
