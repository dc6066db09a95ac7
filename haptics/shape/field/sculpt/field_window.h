#pragma once
// The nodes of a field around a dab, side by side, to be changed.

#include "haptics/shape/field/field_grid.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <vector>

namespace touchstone {

/// A box of nodes. Places in it are counted in voxels from its first node.
struct FieldWindow {
    glm::ivec3 first{0}; ///< node of the grid
    glm::ivec3 size{0};
    double voxel = 0.0;        ///< object units
    std::vector<float> before; ///< as in the grid; the first axis fastest
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
        const auto nx = static_cast<size_t>(size.x), ny = static_cast<size_t>(size.y);
        return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
                static_cast<int>(index / nx / ny)};
    }
    [[nodiscard]] ptrdiff_t step(int axis) const noexcept {
        return axis == 0 ? 1 : axis == 1 ? size.x : static_cast<ptrdiff_t>(size.x) * size.y;
    }
};

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

/// Fills a window with the grid's nodes within `margin` voxels of a ball (object frame); keeps its memory.
/// Returns the ball in it. Throws Error where there would be more than kMostWindowNodes.
SculptZone fillWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                      double margin);

inline constexpr uint64_t kMostWindowNodes = uint64_t{1} << 27;

/// Inclusive; empty where low > high.
struct NodeBox {
    glm::ivec3 low{1}, high{0};
    [[nodiscard]] bool empty() const noexcept { return low.x > high.x; }
    void include(const glm::ivec3& node) noexcept {
        low = empty() ? node : glm::min(low, node);
        high = glm::max(high, node);
    }
};

} // namespace touchstone
