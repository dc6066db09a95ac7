#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchstone::test {

/// What a triangle mesh is once vertices with the same bits are one.
struct Topology {
    size_t vertices = 0, edges = 0, triangles = 0;
    size_t unpairedEdges =
        0; ///< directed edges without exactly one opposite: 0 for a closed oriented surface
    size_t emptyTriangles = 0; ///< with two equal corners
    double volume = 0.0;       ///< m^3, signed: positive if the triangles face outwards

    [[nodiscard]] bool closed() const { return unpairedEdges == 0 && emptyTriangles == 0 && triangles > 0; }
    [[nodiscard]] int euler() const {
        return static_cast<int>(vertices + triangles) - static_cast<int>(edges);
    }
};

[[nodiscard]] Topology topologyOf(const std::vector<glm::vec3>& positions,
                                  const std::vector<uint32_t>& indices);

} // namespace touchstone::test
