#pragma once
// What a driver needs of a scene to compile its programs. Pure; any thread.

#include "engine/scene/scene.h"

#include <vector>

namespace touchstone {

/// The scene with `programs`, one for each of its materials, reduced to one triangle of each mesh that shows
/// one of them, with the images of its material. Null where no mesh shows a program.
[[nodiscard]] ScenePtr programmedPart(const Scene& scene, const std::vector<MaterialProgram>& programs);

} // namespace touchstone
