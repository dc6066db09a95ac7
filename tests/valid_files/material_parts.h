#pragma once

#include "tests/valid_files/accessor_parts.h"

namespace touchstone::test {

/// Adds images, textures, samplers and materials, as the recipe asks for, and fills `draft.materials`.
void addMaterials(FileDraft& draft);

/// Adds the materials of MPEG_material_haptic and KHR_physics_rigid_bodies, and gives them to meshes and
/// nodes.
void addForeignHaptics(FileDraft& draft);

} // namespace touchstone::test
