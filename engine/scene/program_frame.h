#pragma once
// The frame in which haptic programs see a placed mesh: the same for the hand and the picture.

#include "engine/math/nearest_similarity.h"

#include <glm/glm.hpp>

namespace touchstone {

/// The origin is that of the mesh, the axes are those of its node at rest, lengths are metres of the scene at
/// rest. So a mesh that its node scales by s has the positions s x, and an object that moves takes its
/// program along. Of a matrix that mirrors or flattens the axes are those of the scene. `sceneFromMesh`:
/// Instance::sceneFromMesh.
[[nodiscard]] inline Similarity sceneFromProgram(const glm::dmat4& sceneFromMesh) {
    Similarity frame;
    if (!nearestSimilarity(sceneFromMesh, frame))
        frame.translation = glm::dvec3(sceneFromMesh[3]);
    frame.scale = 1.0;
    return frame;
}

/// A program's position is this times the position in the mesh.
[[nodiscard]] inline glm::dmat3 programFromMesh(const glm::dmat4& sceneFromMesh) {
    return glm::transpose(glm::mat3_cast(sceneFromProgram(sceneFromMesh).rotation)) *
           glm::dmat3(sceneFromMesh);
}

} // namespace touchstone
