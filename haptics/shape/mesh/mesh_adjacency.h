#pragma once
// Adjacency of triangle sides: the paths on which the neighbourhood watch walks over a surface (Ho, Basdogan
// and Srinivasan, Presence 8(5), 1999, §3).

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// One side of one triangle: 2 * triangle + 0 for the side that its winding faces (counter-clockwise seen
/// from there), + 1 for its back. Both sides of a sheet can be touched, and they are different places.
using TriangleSide = uint32_t;
[[nodiscard]] constexpr uint32_t triangleOf(TriangleSide side) {
    return side >> 1;
}

/// For each side of each triangle and each of its edges: the first side met on a turn about that edge through
/// free space. Any number of triangles at an edge, wound alike or not, thus has one answer, and the relation
/// is symmetric; at an open border the answer is the triangle's own other side. 24 bytes a triangle.
/// Immutable.
class MeshAdjacency {
  public:
    MeshAdjacency() = default;
    /// `indices`: 3 per triangle. Triangles with two equal corners are left out: their two other edges
    /// coincide, and the triangles beyond them meet there. O(n log n); not for the servo thread.
    MeshAdjacency(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices);

    /// Edge k runs from corner k to corner k + 1.
    [[nodiscard]] TriangleSide across(TriangleSide side, uint32_t edge) const noexcept {
        return across_[3 * static_cast<size_t>(side) + edge];
    }

    [[nodiscard]] size_t edges() const { return edges_; }
    [[nodiscard]] size_t borderEdges() const { return borderEdges_; }           ///< of one triangle
    [[nodiscard]] size_t nonManifoldEdges() const { return nonManifoldEdges_; } ///< of more than two
    [[nodiscard]] uint64_t memoryBytes() const { return across_.size() * sizeof(TriangleSide); }

  private:
    std::vector<TriangleSide> across_;
    size_t edges_ = 0, borderEdges_ = 0, nonManifoldEdges_ = 0;
};

} // namespace touchstone
