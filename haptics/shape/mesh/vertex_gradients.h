#pragma once
// How scalars that a mesh carries at its vertices change over its surface.

#include "haptics/shape/mesh/triangle.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// Gradient within the triangle of the linear function that is f0, f1, f2 at its corners, per unit of its
/// frame. Zero where the triangle has no area. Needs no inverse of anything the values have to do with, so
/// that texture coordinates which collapse are no special case.
[[nodiscard]] inline glm::dvec3 gradientOver(const Triangle& t, double f0, double f1, double f2) {
    // grad of the corner b's hat function is n x (a - c) / (2 area), that of c's n x (b - a) / (2 area).
    const double doubleArea = glm::dot(glm::cross(t.b - t.a, t.c - t.a), t.normal);
    if (!(doubleArea > 0.0))
        return glm::dvec3(0.0);
    return glm::cross(t.normal, (f1 - f0) * (t.a - t.c) + (f2 - f0) * (t.b - t.a)) / doubleArea;
}

/// Two gradients: of u and v, or of a height and nothing.
using GradientPair = std::array<glm::vec3, 2>;

/// What `smoothGradients` reads: a welded mesh (HapticObject has it).
struct GradientMesh {
    std::span<const glm::vec3> vertices;      ///< welded
    std::span<const uint32_t> indices;        ///< 3 per triangle into `vertices`
    std::span<const uint32_t> sourceIndices;  ///< 3 per triangle into the source vertices
    std::span<const glm::vec3> sourceNormals; ///< unit
};

enum class Charted : uint8_t {
    No, ///< a function of the surface, such as a height
    Yes ///< coordinates in charts: beyond a seam they may run elsewhere, or backwards where they are mirrored
};

/// The gradient at each source vertex: the mean, by area, over the triangles round it that share its normal.
/// On a facet alone the gradient is off by the first order of its size; on tessellations as regular as a grid
/// these errors cancel about a vertex, and what is interpolated between vertices is off by the second order,
/// as the interpolated normals are. Not finite where there is no such mean: where charts of several
/// directions meet in one vertex, or more than 256 triangles meet; there the facet's own holds.
[[nodiscard]] std::vector<GradientPair> smoothGradients(const GradientMesh& mesh,
                                                        std::span<const glm::vec2> values, Charted charted);

} // namespace touchstone
