#pragma once

#include "touchstone/touchstone.h"

#include <cstdint>
#include <span>
#include <vector>

namespace touchstone::api {

/// Meshes and materials of a caller.
struct SceneArrays {
    std::vector<ts_mesh> meshes;
    std::vector<ts_material> materials;
};

/// Copies and checks the structs of a caller, each as large as its first says. Throws Refused that names the
/// argument.
[[nodiscard]] SceneArrays arraysOf(const ts_mesh* meshes, size_t meshCount, const ts_material* materials,
                                   size_t materialCount);

/// A GLB that holds them: from there on they are like any file. Throws Refused, and Error beyond 4 GiB.
[[nodiscard]] std::vector<uint8_t> glbOf(const SceneArrays& arrays);

} // namespace touchstone::api
