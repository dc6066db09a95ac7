#pragma once
// Valid glTF 2.0 files out of a recipe: what an exporter may write and an importer must read.

#include "tests/valid_files/recipe.h"

#include <cstdint>
#include <vector>

namespace touchstone::test {

/// The bytes of a .glb, or of a .gltf whose buffer is a data URI. Equal for equal recipes.
[[nodiscard]] std::vector<uint8_t> validFile(const Recipe& recipe);

} // namespace touchstone::test
