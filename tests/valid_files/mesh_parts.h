#pragma once

#include "tests/valid_files/accessor_parts.h"

namespace touchstone::test {

/// Adds a mesh of one or more primitives and returns its index. Materials are there already.
size_t addMesh(FileDraft& draft);

} // namespace touchstone::test
