#pragma once
// Colours of a field's surface: painted nodes, in bricks. Not for the servo thread.

#include "haptics/shape/field/field_grid.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>

namespace touchstone {

/// 8^3 nodes, each in one brick alone. Immutable, shared by all later colours and by the history. Linear RGB,
/// 0..1, by which the material's base colour is multiplied, as glTF's COLOR_0.
struct ColorBrick {
    std::array<glm::vec3, size_t{kBrickCells} * kBrickCells * kBrickCells> nodes{};
    uint64_t hash = 0; ///< of the nodes
};
using ColorBrickPtr = std::shared_ptr<const ColorBrick>;

/// White (1, 1, 1) wherever nothing was painted. Immutable.
class FieldColors {
  public:
    /// By `brickNumber`; none is null.
    FieldColors(const FieldLayout& layout, std::map<uint32_t, ColorBrickPtr> bricks)
        : layout_(layout), bricks_(std::move(bricks)) {}

    /// Trilinear between nodes; object frame. White outside of the grid.
    [[nodiscard]] glm::vec3 at(const glm::dvec3& place) const;
    [[nodiscard]] glm::vec3 node(const glm::ivec3& at) const;
    /// Of the colours alone: the order in which they were painted does not matter.
    [[nodiscard]] uint64_t hash() const;

    /// The brick that holds a node, which lies in the grid.
    [[nodiscard]] static uint32_t brickNumber(const FieldLayout& layout, const glm::ivec3& node);
    /// Of a node within its brick.
    [[nodiscard]] static size_t indexOf(const glm::ivec3& node);
    /// Bricks on each axis: a node more than a cell can make one more than those of the FieldGrid.
    [[nodiscard]] static glm::ivec3 bricksOf(const FieldLayout& layout);
    /// A brick with these nodes and their hash; null where all are white.
    [[nodiscard]] static ColorBrickPtr brickOf(const ColorBrick& nodes);

  private:
    FieldLayout layout_;
    std::map<uint32_t, ColorBrickPtr> bricks_;
};

} // namespace touchstone
