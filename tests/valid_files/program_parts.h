#pragma once

#include "tests/valid_files/accessor_parts.h"

namespace touchstone::test {

/// Adds a haptic program, with a persistent texture and what touch had made of it, as the recipe asks for.
/// `ours`: TOUCHSTONE_materials_haptic of a material.
void addProgram(FileDraft& draft, nlohmann::json& ours);

} // namespace touchstone::test
