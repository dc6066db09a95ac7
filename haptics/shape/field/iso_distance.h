#pragma once
// From values on a grid to distances from the surface where they are zero.

#include "engine/core/progress.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace touchstone {

/// Node values, the first axis fastest, `nodes` on each (at least 4).
struct NodeValues {
    glm::ivec3 nodes{0};
    std::vector<float> value;
};

/// Replaces values (negative inside) by signed distances in voxels from the surface where their trilinear
/// interpolation is zero; beyond `inside` and `outside` by +-kFarNode. Nodes of cells that the surface
/// passes tell the distance along their gradient, or along the shortest of the 26 ways to a node of the other
/// side where that is less; the others solve |grad f| = 1 by its first-order upwind scheme (H. Zhao, A fast
/// sweeping method for Eikonal equations, 2005) in one round of eight sweeps over bricks. The layer of nodes
/// at the border repeats the next one. False, and the values as they were, where more than `mostNear` nodes
/// are next to the surface, of each of which it keeps a note. Two threads; the same result with one. Throws
/// Cancelled.
[[nodiscard]] bool toDistances(NodeValues& grid, double inside, double outside, uint64_t mostNear,
                               const Progress& progress = {});

inline constexpr float kFarNode = 1e6f;

} // namespace touchstone
