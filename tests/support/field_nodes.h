#pragma once
// The values of a distance field.

#include "haptics/shape/field/field_grid.h"

#include <cstddef>
#include <vector>

namespace touchstone::test {

/// At all nodes, x fastest.
inline std::vector<float> allNodes(const FieldGrid& grid) {
    const glm::ivec3 size = grid.layout().cells + 1;
    std::vector<float> nodes(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) *
                             static_cast<size_t>(size.z));
    grid.copyNodes(glm::ivec3(0), size, nodes);
    return nodes;
}

} // namespace touchstone::test
