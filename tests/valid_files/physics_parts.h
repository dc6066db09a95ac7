#pragma once

#include "tests/valid_files/accessor_parts.h"

namespace touchstone::test {

/// Adds physics materials and colliders, and bodies with joints, as the recipe asks for.
void addPhysics(FileDraft& draft);

} // namespace touchstone::test
