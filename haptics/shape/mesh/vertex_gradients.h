#pragma once
// Surface gradients of scalars that a mesh stores at its vertices.

#include "haptics/shape/mesh/triangle.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// Gradient within the triangle of the linear function that is f0, f1, f2 at its corners, per unit of its
/// frame. Zero where the triangle has no area. Inverts nothing that depends on the values, so that collapsed
/// texture coordinates are no special case.
[[nodiscard]] inline glm::dvec3 gradientOver(const Triangle& t, double f0, double f1, double f2) {
    // grad of the corner b's hat function is n x (a - c) / (2 area), that of c's n x (b - a) / (2 area).
    const double doubleArea = glm::dot(glm::cross(t.b - t.a, t.c - t.a), t.normal);
    if (!(doubleArea > 0.0))
        return glm::dvec3(0.0);
    return glm::cross(t.normal, (f1 - f0) * (t.a - t.c) + (f2 - f0) * (t.b - t.a)) / doubleArea;
}

/// Two gradients: of u and v, or of a height alone.
using GradientPair = std::array<glm::vec3, 2>;

/// Input of `smoothGradients`: a welded mesh (HapticObject has one).
struct GradientMesh {
    std::span<const glm::vec3> vertices;      ///< welded
    std::span<const uint32_t> indices;        ///< 3 per triangle into `vertices`
    std::span<const uint32_t> sourceIndices;  ///< 3 per triangle into the source vertices
    std::span<const glm::vec3> sourceNormals; ///< unit
};

enum class Charted : uint8_t {
    No, ///< a function of the surface, such as a height
    Yes ///< coordinates in charts: beyond a seam they may have another direction, or be mirrored
};

/// The gradient at each source vertex: the area-weighted mean over the adjacent triangles that share its
/// normal. On a single facet the gradient has an error of first order in the facet's size; on tessellations
/// as regular as a grid these errors cancel about a vertex, and the values interpolated between vertices have
/// an error of second order, like the interpolated normals. Not finite where there is no such mean: where
/// charts of several directions meet in one vertex, or more than 256 triangles meet; there the facet's own
/// gradient applies.
[[nodiscard]] std::vector<GradientPair> smoothGradients(const GradientMesh& mesh,
                                                        std::span<const glm::vec2> values, Charted charted);

} // namespace touchstone
