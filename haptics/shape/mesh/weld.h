#pragma once

#include "engine/core/progress.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

struct WeldResult {
    std::vector<glm::vec3> vertices; ///< one per cluster: the position of its first vertex
    std::vector<uint32_t> remap;     ///< input vertex -> cluster
    uint32_t merged = 0;             ///< vertices that moved onto another one of a different position
};

/// Joins vertices nearer than `tolerance` (same unit) to the first such vertex. Positions never move farther
/// than `tolerance`. O(n) by hashing. Throws Cancelled.
[[nodiscard]] WeldResult weldVertices(std::span<const glm::vec3> positions, double tolerance,
                                      const Progress& progress = {});

/// True when every edge has an even number of triangles: the surface bounds a volume whatever its windings
/// are, and rays cross it an even number of times. Triangles with two equal corners do not count. Three
/// indices a triangle, below `vertexCount`. O(n). Throws Cancelled.
[[nodiscard]] bool isClosed(std::span<const uint32_t> indices, size_t vertexCount,
                            const Progress& progress = {});

} // namespace touchstone
