#pragma once
// Distances of places from a mesh, eight at a time. Not for the servo thread.

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// A mesh's triangles in a binary tree of boxes. The distances are those to the nearest of all triangles, but
/// for the rounding of doubles: nothing is handed on from a place to its neighbour but a bound.
class NearestTriangles {
  public:
    static constexpr size_t kPlaces = 8;

    NearestTriangles(std::span<const glm::dvec3> vertices, std::span<const uint32_t> indices);

    /// Lowers `squared`, an upper bound for each place, to the squared distance from the mesh where that is
    /// less. Places that lie near each other take least time. `known`: a triangle, best one that is near;
    /// becomes one that is nearest to a place.
    void lower(std::span<const glm::dvec3, kPlaces> places, std::span<double, kPlaces> squared,
               uint32_t& known) const noexcept;

    [[nodiscard]] bool empty() const noexcept { return triangles_.empty(); }

  private:
    /// The left child follows its parent. The box holds the triangles: its sides are rounded outwards.
    struct Node {
        glm::vec3 low, high;
        uint32_t right = 0; ///< child; 0 in a leaf
        uint32_t item = 0;  ///< the triangle of a leaf; else the axis along which the children lie
        float middle = 0.0f;
    };
    /// What a distance needs: a corner, the edges from it, reciprocals of the squared lengths of the three
    /// edges and the inverse of the Gram matrix of the two (0 where they are parallel).
    struct Triangle {
        glm::dvec3 corner, ab, ac;
        glm::dvec3 perSquare; ///< of ab, ac, bc
        glm::dvec3 inverse;   ///< ab ab, ab ac, ac ac
    };
    void build(std::span<uint32_t> items, std::span<const glm::dvec3> centres);

    std::vector<Node> nodes_;
    std::vector<Triangle> triangles_;
};

} // namespace touchstone
