#pragma once
// Shapes whose distance is known in closed form, with a stroke: what a field of them is compared with.

#include "assets/shapes.h"
#include "study/timing/bench_scene.h"
#include "study/truth/smooth_shape.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <functional>
#include <string>
#include <vector>

namespace touchstone::study {

/// Lengths in m, workspace, about the origin.
struct VoxelShape {
    std::string name;
    /// Signed distance, negative inside.
    std::function<double(const glm::dvec3&)> distance;
    glm::dvec3 half{0.0}; ///< half the sides of its box
    /// workspaceFromGrid: edges cross the grid obliquely.
    glm::dquat gridTurn{1.0, 0.0, 0.0, 0.0};
    BenchStroke stroke;
    truth::SmoothShapePtr smooth; ///< null: the oracle on the mesh, whose facets are the shape's own faces
    /// Of about so many triangles; empty: none.
    std::function<assets::Shape(size_t triangles)> mesh;
    size_t triangles = 0; ///< of the mesh that is compared

    [[nodiscard]] double diagonal() const { return 2.0 * glm::length(half); }
};

/// Sphere (radius 50 mm), torus (60 and 25 mm), box (100 mm, touched up to and over one of its edges) and
/// groove (90° in a block, touched along its line).
[[nodiscard]] std::vector<VoxelShape> voxelShapes();

} // namespace touchstone::study
