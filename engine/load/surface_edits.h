#pragma once
// Changed numbers of the surfaces that a file has no material for (Material::fileIndex < 0), in recordings:
// a patch of the file's materials (engine/save/material_patch.h) cannot name them.

#include "engine/scene/scene.h"

#include <map>
#include <string>

namespace touchstone {

/// By the name of the number (engine/scene/haptic_numbers.h); all such surfaces have the same.
using SurfaceNumbers = std::map<std::string, float, std::less<>>;

/// `edits` (MaterialPatches as text) with the numbers as its member "surface"; the same without numbers.
[[nodiscard]] std::string withSurfaceNumbers(const std::string& edits, const SurfaceNumbers& numbers);
/// Removes the member. Empty where there is none. Throws Error where a number is none that can be changed.
[[nodiscard]] SurfaceNumbers takeSurfaceNumbers(std::string& edits);
/// What the surfaces state from now on. Before the scene is shared.
void stateSurfaceNumbers(Scene& scene, const SurfaceNumbers& numbers);

} // namespace touchstone
