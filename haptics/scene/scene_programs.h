#pragma once
// Haptic programs of a compiled scene.

#include "engine/scene/scene.h"
#include "haptics/program/felt_program.h"
#include "haptics/scene/haptic_scene.h"

#include <cstddef>

namespace touchstone {

/// Gives material `index` of `haptic` the program of `material`, with a warning where the executor does not
/// accept it. `before`: that of the material before an edit; may be null. Not for the servo.
void addProgram(const Material& material, size_t index, const program::FeltProgram* before,
                HapticScene& haptic);

/// Fills HapticScene::programFromObject where some material has a program. `source`: what it was compiled
/// from.
void placePrograms(const Scene& source, HapticScene& haptic);

} // namespace touchstone
