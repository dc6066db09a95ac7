#pragma once
// A floor of 0.2 m at y = 0 and hands over it.

#include "touchstone/touchstone.hpp"

#include <cmath>
#include <vector>

namespace touchstone::test {

inline ts::Mesh floorMesh() {
    ts::Mesh mesh;
    mesh.positions = {{-0.1f, 0.0f, -0.1f}, {-0.1f, 0.0f, 0.1f}, {0.1f, 0.0f, 0.1f}, {0.1f, 0.0f, -0.1f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// `rows` positions from 5 mm above the floor to 5 mm below it.
inline std::vector<ts::Vector> press(size_t rows) {
    std::vector<ts::Vector> path(rows);
    for (size_t i = 0; i < rows; ++i)
        path[i] = {0.01, 0.005 - 0.01 * static_cast<double>(i) / static_cast<double>(rows - 1), 0.003};
    return path;
}

} // namespace touchstone::test
