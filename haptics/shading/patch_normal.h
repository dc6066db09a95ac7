#pragma once
// Tactile shading's interpolation on triangles: a quadratic patch of normals (docs/fingers.md).

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// A Bezier patch of degree two over a triangle's normals, not of unit length. Its control vector at an edge
/// e is
///   c_ij = m - 3 (e . m) / (e . e) e,  m = (n_i + n_j) / 2.
/// Along a smooth curve the slope at the middle of a chord is 3/2 chord's - 1/2 the mean of the ends'
/// (Simpson's rule on the slope, whose integral is the chord), so that half of m plus half of c_ij has that
/// slope, and the normals are right to third order along each edge; plain interpolation of normals is to
/// second. On a sphere e . m is zero, and nothing changes. The edge's vectors are those of its two vertices
/// alone: neighbouring triangles have the same normals on it. `corners` in any frame, `normals` unit vectors,
/// `weight` barycentric.
[[nodiscard]] inline glm::dvec3 patchNormal(const std::array<glm::dvec3, 3>& corners,
                                            const std::array<glm::dvec3, 3>& normals,
                                            const glm::dvec3& weight) noexcept {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 3; ++i)
        sum += weight[i] * normals[static_cast<size_t>(i)];
    for (int i = 0; i < 3; ++i) {
        const auto a = static_cast<size_t>(i), b = static_cast<size_t>((i + 1) % 3);
        const glm::dvec3 e = corners[b] - corners[a];
        const double squared = glm::dot(e, e);
        if (squared > 0.0)
            sum -= 3.0 * weight[i] * weight[(i + 1) % 3] * glm::dot(e, normals[a] + normals[b]) / squared * e;
    }
    return sum;
}

} // namespace touchstone
