#pragma once

#include "renderer/scene_vertex.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace touchstone {

/// Triangles in place of those of a mesh of the scene, which change while they are seen. Mesh frame.
struct ReshapedMesh {
    glm::dvec3 centre{0.0}; ///< the packed positions are relative to it
    glm::dvec3 halfSize{0.0};
    double radius = 0.0;   ///< of a ball about the centre that contains all vertices
    double meanEdge = 0.0; ///< of the triangles
    std::vector<SceneVertex> vertices;
    std::vector<uint32_t> indices; ///< 3 a triangle
    bool hasColors = false;        ///< the vertices' colours say something
};

} // namespace touchstone
