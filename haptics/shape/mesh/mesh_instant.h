#pragma once
// The vertices of a deforming mesh in one tick: between two published arrays, and where they were a tick ago.

#include <glm/glm.hpp>

#include <cstddef>

namespace touchstone {

class TriangleTree;

/// A place between two published arrays of vertices; object frame.
struct VertexBlend {
    const glm::vec3* from = nullptr;
    const glm::vec3* to = nullptr;
    double fraction = 0.0; ///< 0..1 from `from` to `to`

    [[nodiscard]] glm::dvec3 at(size_t vertex) const noexcept {
        const glm::dvec3 a(from[vertex]);
        return a + fraction * (glm::dvec3(to[vertex]) - a);
    }
};

/// Written by the servo at a tick's start; read by everything that queries the object in that tick. Within a
/// tick a vertex moves straight from `before` to `now`.
struct MeshInstant {
    VertexBlend now, before;
    VertexBlend normals;                ///< of the source vertices, not of unit length; null without any
    const TriangleTree* tree = nullptr; ///< its boxes hold the triangles of `now`
    double travel = 0.0;                ///< no vertex moves farther in this tick, object units
};

} // namespace touchstone
