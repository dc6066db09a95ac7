#pragma once
// The nodes of 8^3 cells of a field.

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace touchstone {

inline constexpr int kBrickCells = 8;              ///< a side
inline constexpr int kBrickSide = kBrickCells + 1; ///< nodes: the last ones are also those of the next brick
inline constexpr size_t kNodesInBrick = size_t{kBrickSide} * kBrickSide * kBrickSide;

[[nodiscard]] inline size_t brickNode(const glm::ivec3& inBrick) noexcept {
    return static_cast<size_t>(inBrick.x + kBrickSide * (inBrick.y + kBrickSide * inBrick.z));
}

/// Calls visit(index in brick) for every node of a brick.
template <class Visit>
void eachBrickNode(const Visit& visit) {
    for (int z = 0; z < kBrickSide; ++z)
        for (int y = 0; y < kBrickSide; ++y)
            for (int x = 0; x < kBrickSide; ++x)
                visit(glm::ivec3(x, y, z));
}

/// What a field keeps of a brick besides its nodes.
struct BrickMeasure {
    float steepest = 0.0f; ///< bound of |gradient|^2, in values a cell edge
    glm::ivec3 low{1},
        high{0}; ///< grid bounds of the cells with a node that is not positive; low > high: none
};
/// `cells` of the brick lie in the grid; `first` is its first node.
[[nodiscard]] BrickMeasure measureBrick(const glm::ivec3& first, const glm::ivec3& cells,
                                        std::span<const float, kNodesInBrick> nodes);

/// A brick that replaces one of a grid. Immutable, shared by all later grids and by the history.
struct EditedBrick {
    std::array<float, kNodesInBrick> nodes{};
    float flat = 0.0f; ///< the value of all nodes; NaN where they differ
    BrickMeasure measure;
    uint64_t hash = 0; ///< of the nodes
};
/// Measures `nodes`.
[[nodiscard]] std::shared_ptr<const EditedBrick> editedBrick(const glm::ivec3& first, const glm::ivec3& cells,
                                                             std::span<const float, kNodesInBrick> nodes);

struct BrickEdit {
    uint32_t number = 0; ///< FieldGrid::brickNumber
    std::shared_ptr<const EditedBrick> brick;
};

} // namespace touchstone
