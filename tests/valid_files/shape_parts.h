#pragma once
// Geometry in plain numbers, with whatever irregularities a valid file may hold.

#include "tests/valid_files/accessor_parts.h"

#include <glm/glm.hpp>

#include <vector>

namespace touchstone::test {

struct RawShape {
    std::vector<glm::dvec3> positions, normals; ///< normals are unit
    std::vector<glm::dvec2> uv;
    std::vector<uint32_t> indices; ///< triangle list
    double size = 1.0;             ///< m, about
};

/// At most a few hundred triangles.
[[nodiscard]] RawShape drawShape(FileDraft& draft);

} // namespace touchstone::test
