#pragma once
// Node values of a scalar field on a regular grid, in bricks.

#include "haptics/shape/field/field_brick.h"
#include "haptics/shape/field/field_cell.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// Where the nodes are: node (i, j, k) at origin + voxel * (i, j, k), for 0 <= i <= cells.x and so on. Object
/// frame.
struct FieldLayout {
    glm::dvec3 origin{0.0};
    double voxel = 0.0;
    glm::ivec3 cells{0};
};

/// A field f, negative inside of the object, trilinear between float nodes and continuous: C0, with kinks at
/// the faces of cells. Immutable. Cells are kept in bricks of 8^3; a brick whose nodes are all equal takes
/// no nodes, and the last nodes of the others are kept once, as the first of the next bricks. Outside of the
/// grid f is the value at the nearest place of the grid and the distance to it.
///
/// The servo reads it without an allocation or a lock; a query costs the same in a small grid and in a large
/// one.
class FieldGrid {
  public:
    static constexpr int kBrick = kBrickCells; ///< cells a side
    static constexpr int kNodes = kBrickSide;  ///< nodes a side
    static constexpr size_t kBrickNodes = kNodesInBrick;
    static constexpr int kMostOnAxis = 1 << 16;               ///< cells
    static constexpr uint64_t kMostCells = uint64_t{1} << 32; ///< a cell's number has 32 bits

    /// `nodes` (x fastest, kNodes a side) of the brick whose first node is `first`. Nodes beyond the grid may
    /// be anything; those that two bricks share have the same value in both.
    using FillBrick = std::function<void(const glm::ivec3& first, std::span<float> nodes)>;

    /// Calls `fill` once for each brick. Values are clamped to -inside .. outside: beyond these distances
    /// from the surface the field is flat. Throws Error where the layout holds no cell, too many, or is not
    /// finite, where a node is not a number, and where the object reaches the border of the grid (it has to
    /// lie inside by a voxel).
    FieldGrid(const FieldLayout& layout, double inside, double outside, const FillBrick& fill);

    /// The grid `base`, which is not edited itself, with other bricks in some places: in increasing order of
    /// their numbers. Shares all others with it. Takes time for tables of 20 bytes a brick, not for nodes.
    FieldGrid(std::shared_ptr<const FieldGrid> base, std::vector<BrickEdit> edits);

    [[nodiscard]] const FieldLayout& layout() const noexcept { return layout_; }
    [[nodiscard]] double inside() const noexcept { return inside_; }
    [[nodiscard]] double outside() const noexcept { return outside_; }
    /// At least |f(a) - f(b)| / |a - b| for all a, b.
    [[nodiscard]] double lipschitz() const noexcept { return lipschitz_; }
    [[nodiscard]] size_t memoryBytes() const noexcept;
    /// Of layout and values; of an edited grid that of its base and of the bricks that differ from it.
    [[nodiscard]] uint64_t hash() const noexcept { return hash_; }
    /// The bounds of all cells with a node that is not positive, object frame; low > high where there is
    /// none.
    [[nodiscard]] const glm::dvec3& low() const noexcept { return low_; }
    [[nodiscard]] const glm::dvec3& high() const noexcept { return high_; }

    /// Grid coordinates, a voxel apart, of a place in the object frame.
    [[nodiscard]] glm::dvec3 gridFromObject(const glm::dvec3& p) const noexcept {
        return (p - layout_.origin) / layout_.voxel;
    }
    /// The cell that contains the place; the nearest one from outside of the grid.
    [[nodiscard]] glm::ivec3 cellAt(const glm::dvec3& grid) const noexcept;
    [[nodiscard]] bool contains(const glm::ivec3& cell) const noexcept {
        return cell.x >= 0 && cell.y >= 0 && cell.z >= 0 && cell.x < layout_.cells.x &&
               cell.y < layout_.cells.y && cell.z < layout_.cells.z;
    }
    [[nodiscard]] FieldCell cell(const glm::ivec3& at) const noexcept;
    /// The value that all nodes of the cell's brick have; NaN where they differ.
    [[nodiscard]] float flatBrick(const glm::ivec3& cell) const noexcept;

    [[nodiscard]] uint32_t numberOf(const glm::ivec3& cell) const noexcept;
    [[nodiscard]] glm::ivec3 cellOf(uint32_t number) const noexcept;

    [[nodiscard]] const glm::ivec3& bricks() const noexcept { return bricks_; } ///< on each axis
    [[nodiscard]] uint32_t brickNumber(const glm::ivec3& brick) const noexcept;
    /// The nodes of a brick, which may be flat; those beyond the grid are outside().
    void copyBrick(const glm::ivec3& brick, std::span<float, kBrickNodes> nodes) const noexcept;
    /// The values of `size` nodes from `first` on, the first axis fastest; all of them in the grid.
    void copyNodes(const glm::ivec3& first, const glm::ivec3& size, std::span<float> values) const noexcept;
    /// Whole rows that a brick keeps itself, or that are flat, of 8 or 9 nodes: those from `from` to before
    /// `end` (y and z in the brick). Into a part of a larger box: its rows begin `row` floats apart, its
    /// layers `layer`.
    void copyRows(const glm::ivec3& brick, const glm::ivec2& from, const glm::ivec2& end, float* values,
                  size_t row, size_t layer) const noexcept;
    /// copyNodes into such a part.
    void copyNodes(const glm::ivec3& first, const glm::ivec3& size, float* values, size_t row,
                   size_t layer) const noexcept;

    /// Gradient at a node, by central differences, per object unit; one-sided at the border.
    [[nodiscard]] glm::dvec3 nodeGradient(const glm::ivec3& node) const noexcept;
    [[nodiscard]] double node(const glm::ivec3& at) const noexcept;

  private:
    struct Brick {
        const float* nodes; ///< null: all are `flat`
        float flat;
        /// Nodes that are kept on each axis: kBrick, or kNodes where no brick follows that has the last ones,
        /// and in edited bricks.
        uint32_t side;
        [[nodiscard]] uint32_t place(const glm::uvec3& at) const noexcept {
            return at.x + side * (at.y + side * at.z);
        }
        [[nodiscard]] float value(const glm::uvec3& at) const noexcept {
            return nodes == nullptr ? flat : nodes[place(at)];
        }
        /// How many nodes of a row are here.
        [[nodiscard]] int inRow() const noexcept {
            return nodes == nullptr ? kNodes : static_cast<int>(side);
        }
        /// The nodes from `from` to before `end`, as FieldGrid::copyRows.
        void copy(const glm::ivec3& from, const glm::ivec3& end, float* values, size_t row,
                  size_t layer) const noexcept;
    };
    void fillBrick(const glm::ivec3& brick, const FillBrick& fill, std::vector<float>& nodes);
    [[nodiscard]] Brick kept(const glm::ivec3& brick, std::span<const float> nodes);
    [[nodiscard]] float valueIn(glm::ivec3 brick, glm::ivec3 at) const noexcept;
    void include(const BrickMeasure& measure);
    void setLipschitz();
    void checkBorder(const glm::ivec3& first, std::span<const float> nodes) const;
    [[nodiscard]] const Brick& brickOf(const glm::ivec3& brick) const noexcept;

    FieldLayout layout_;
    double inside_, outside_, lipschitz_ = 0.0;
    glm::ivec3 bricks_{0};
    std::vector<Brick> table_;
    std::vector<float> steepest_;           ///< BrickMeasure::steepest; 0 in flat bricks
    std::shared_ptr<const FieldGrid> base_; ///< of an edited grid: the owner of all other nodes
    std::vector<BrickEdit> edits_;
    /// Nodes, kChunk floats each: growing copies nothing.
    static constexpr size_t kChunk = size_t{64} * kBrick * kBrick * kBrick;
    std::vector<std::unique_ptr<float[]>> chunks_;
    size_t used_ = kChunk; ///< of the last one
    glm::dvec3 low_{INFINITY}, high_{-INFINITY};
    uint64_t hash_ = 0;
};

/// The grid of a function that is a distance (its gradient is a unit vector wherever there is one): bricks
/// that are farther from the surface than the field reaches are not evaluated node by node.
[[nodiscard]] FieldGrid gridOfDistance(const FieldLayout& layout, double inside, double outside,
                                       const std::function<double(const glm::dvec3&)>& distance);

} // namespace touchstone
