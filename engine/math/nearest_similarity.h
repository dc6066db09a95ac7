#pragma once
// Conversion of matrices to similarities.

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <cmath>

namespace touchstone {

/// The similarity nearest to a matrix: scale from the volume, axes orthogonalised by Gram and Schmidt, which
/// preserves the rotation of a matrix that has one. False where the matrix mirrors, flattens or is not
/// finite: `similarity` is then unchanged.
inline bool nearestSimilarity(const glm::dmat4& matrix, Similarity& similarity) {
    const glm::dmat3 linear(matrix);
    const double volume = glm::determinant(linear);
    if (!(volume > 0.0) || !std::isfinite(volume))
        return false;
    const glm::dvec3 x = glm::normalize(linear[0]);
    const glm::dvec3 across = linear[1] - glm::dot(linear[1], x) * x;
    // Rounding gives parallel columns a small volume and an arbitrary second axis.
    constexpr double kFlat = 1e-12;
    if (!(glm::length(across) > kFlat * glm::length(linear[1])))
        return false;
    const glm::dvec3 y = glm::normalize(across);
    const Similarity nearest{std::cbrt(volume),
                             glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)))),
                             glm::dvec3(matrix[3])};
    if (!std::isfinite(glm::dot(nearest.translation, nearest.translation)) || !(nearest.scale > 0.0) ||
        !std::isfinite(glm::dot(nearest.rotation, nearest.rotation)))
        return false;
    similarity = nearest;
    return true;
}

[[nodiscard]] inline glm::dmat4 matrixOf(const Similarity& similarity) {
    glm::dmat4 matrix = glm::mat4_cast(similarity.rotation);
    for (int column = 0; column < 3; ++column)
        matrix[column] *= similarity.scale;
    matrix[3] = glm::dvec4(similarity.translation, 1.0);
    return matrix;
}

} // namespace touchstone
