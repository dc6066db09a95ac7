#pragma once
// The nodes of a field around a dab, side by side, to be changed.

#include "haptics/shape/field/field_grid.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace touchstone {

/// Inclusive; empty where low > high.
struct NodeBox {
    glm::ivec3 low{1}, high{0};
    [[nodiscard]] bool empty() const noexcept { return low.x > high.x; }
    void include(const glm::ivec3& node) noexcept {
        low = empty() ? node : glm::min(low, node);
        high = glm::max(high, node);
    }
};

/// A box of whole bricks of a grid, of which those that a dab may change are active. Only nodes of active
/// bricks, and two around, have values. Places in it are counted in voxels from its first node.
struct FieldWindow {
    const FieldGrid* grid = nullptr; ///< as it was before the dab
    glm::ivec3 first{0};             ///< node of the grid, the first one of a brick
    glm::ivec3 size{0};
    glm::ivec3 bricks{0};           ///< on each axis
    std::vector<uint8_t> isActive;  ///< of each brick, the first axis fastest
    std::vector<glm::ivec3> active; ///< in the same order
    std::vector<NodeBox> around;    ///< the other nodes that have values, a box of each brick
    double voxel = 0.0;             ///< object units
    std::vector<float> before;      ///< as in the grid; the first axis fastest
    std::vector<float> value;

    [[nodiscard]] uint64_t nodes() const noexcept {
        return uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z);
    }
    [[nodiscard]] size_t index(const glm::ivec3& at) const noexcept {
        return static_cast<size_t>(at.x) +
               static_cast<size_t>(size.x) *
                   (static_cast<size_t>(at.y) + static_cast<size_t>(size.y) * static_cast<size_t>(at.z));
    }
    [[nodiscard]] bool contains(const glm::ivec3& at) const noexcept {
        return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
    }
    [[nodiscard]] glm::ivec3 nodeAt(size_t index) const noexcept {
        // Of 32 bits, as kMostWindowNodes allows: their division is the cheaper one.
        const auto nx = static_cast<uint32_t>(size.x), ny = static_cast<uint32_t>(size.y);
        const uint32_t row = static_cast<uint32_t>(index) / nx, layer = row / ny;
        return {static_cast<int>(static_cast<uint32_t>(index) - row * nx), static_cast<int>(row - layer * ny),
                static_cast<int>(layer)};
    }
    [[nodiscard]] ptrdiff_t step(int axis) const noexcept {
        return axis == 0 ? 1 : axis == 1 ? size.x : static_cast<ptrdiff_t>(size.x) * size.y;
    }
    [[nodiscard]] size_t brickIndex(const glm::ivec3& brick) const noexcept {
        return static_cast<size_t>(brick.x + bricks.x * (brick.y + bricks.y * brick.z));
    }
    /// The brick of a cell. Each node belongs to the cell that begins at it, the last one on an axis to the
    /// cell before.
    [[nodiscard]] bool cellIsActive(const glm::ivec3& cell) const noexcept {
        const glm::ivec3 brick(glm::uvec3(cell) / static_cast<uint32_t>(kBrickCells));
        return isActive[brickIndex(glm::min(brick, bricks - 1))] != 0;
    }
    /// Inclusive.
    [[nodiscard]] glm::ivec3 lastNode(const glm::ivec3& brick) const noexcept {
        const glm::ivec3 end = kBrickCells * (brick + 1);
        return {brick.x + 1 == bricks.x ? size.x - 1 : end.x - 1,
                brick.y + 1 == bricks.y ? size.y - 1 : end.y - 1,
                brick.z + 1 == bricks.z ? size.z - 1 : end.z - 1};
    }
    /// Calls visit(first node, index, count) for each row of nodes along the first axis in active bricks,
    /// each node once.
    template <class Visit>
    void eachActiveRow(const Visit& visit) const {
        for (const glm::ivec3& brick : active)
            eachRow({kBrickCells * brick, lastNode(brick)}, visit);
    }
    template <class Visit>
    void eachRow(const NodeBox& box, const Visit& visit) const {
        for (int z = box.low.z; z <= box.high.z; ++z)
            for (int y = box.low.y; y <= box.high.y; ++y)
                visit(glm::ivec3(box.low.x, y, z), index({box.low.x, y, z}), box.high.x - box.low.x + 1);
    }
};

inline void copyRow(const float* from, int count, float* to) noexcept {
    if (count == kBrickCells)
        std::memcpy(to, from, kBrickCells * sizeof(float)); // no call, as the length is known
    else
        std::copy_n(from, count, to);
}

/// A ball: of the nodes that a dab changes by itself.
struct SculptZone {
    glm::dvec3 centre{0.0}; ///< in the window
    double radius = 0.0;    ///< voxels

    /// The nodes of its box with `margin` voxels, `spare` nodes away from the window's border.
    [[nodiscard]] glm::ivec3 low(double margin, int spare) const noexcept;
    [[nodiscard]] glm::ivec3 high(const FieldWindow& window, double margin, int spare) const noexcept;
    [[nodiscard]] bool contains(const glm::ivec3& node, double margin = 0.0) const noexcept {
        const glm::dvec3 away = glm::dvec3(node) - centre;
        return glm::dot(away, away) <= (radius + margin) * (radius + margin);
    }
};

/// True where a ball (object frame) has no place in common with the grid.
[[nodiscard]] bool ballMisses(const FieldGrid& grid, const glm::dvec3& centre, double radius) noexcept;

/// The first part of fillWindow: where the window lies, without its nodes. Throws the same Error.
void placeWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                 double margin);

/// Makes a window of the nodes within `margin` voxels of a ball (object frame), of a grid as it was before
/// the dab and as it is now, which may be the same; keeps its memory.
/// Active are the bricks around the ball, and those with a node that may have its nearest place on the
/// surface in the ball, now or after the dab: one that is not farther from the ball than from the surface.
/// Under a flat face these are the bricks in a paraboloid, not in a cube. Returns the ball in the window.
/// Throws Error where there would be more than kMostWindowNodes.
SculptZone fillWindow(FieldWindow& window, const FieldGrid& before, const FieldGrid& now,
                      const glm::dvec3& centre, double radius, double margin);

/// The same window for a tool alone, which reads no nodes around active bricks: they have no values. Active
/// are only bricks within `activeMargin` voxels of the ball. Its first node is that of fillWindow: the ball's
/// centre in the window has the same last bits, and so has what the tool makes.
SculptZone fillShapeWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre,
                           double radius, double margin, double activeMargin);

inline constexpr uint64_t kMostWindowNodes = uint64_t{1} << 27;

/// Boxes, none of which reaches into two bricks, that hold all nodes whose value is not that of before.
[[nodiscard]] std::vector<NodeBox> changedNodes(const FieldWindow& window);

} // namespace touchstone
