#pragma once
// Hollow corners of one to three walls, each of a material of its own, and what the closed form says of a HIP
// in them.

#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/haptic_step.h"

#include <glm/glm.hpp>

#include <array>
#include <vector>

namespace touchstone::test {

/// m: of the ball in a corner's closed forms.
inline constexpr double kCornerRadius = 1e-5;
/// That ball without shading, texture and friction.
[[nodiscard]] HapticSettings cornerSettings();

/// One wall: a plane through the origin, its material as the file would state it.
struct Wall {
    glm::dvec3 normal{0.0}; ///< unit, towards the hollow
    float stiffness = 500.0f, damping = 0.0f, staticFriction = 0.0f, dynamicFriction = 0.0f,
          viscousFriction = 0.0f;
};

/// A groove along z, open to +y, of the given angle (rad); stiffness of its walls in N/m.
[[nodiscard]] std::vector<Wall> groove(double angle, float left, float right);

/// Walls of about `reach` m round the origin. Two meet along their cross product; three in the origin. One
/// mesh and one material each.
[[nodiscard]] Scene cornerScene(const std::vector<Wall>& walls, double reach = 0.2);

/// The planes of the walls as the compiled scene has them: unit normal . x >= offset in the hollow.
/// Workspace.
struct Corner {
    std::vector<glm::dvec3> normals;
    std::vector<double> offsets; ///< m; not zero, since positions are rounded to float
};
[[nodiscard]] Corner cornerOf(const HapticScene& scene);

/// The least singular value of the matrix of the normals.
[[nodiscard]] double minSingularValue(const std::vector<glm::dvec3>& normals);

/// p - h = sum lambda_i n_i for the place p nearest to h of a ball of `radius` in the hollow, by trying every
/// set of walls.
struct CornerSolve {
    glm::dvec3 place{0.0};
    std::array<double, 3> load{}; ///< lambda by wall, m
    int count = 0;                ///< of walls that hold it
};
[[nodiscard]] CornerSolve solveCorner(const Corner& corner, double radius, const glm::dvec3& hip);

/// N: the elastic force of a solve, sum k_i lambda_i n_i.
[[nodiscard]] glm::dvec3 elasticOf(const std::vector<glm::dvec3>& normals, const std::vector<Wall>& walls,
                                   const CornerSolve& solve);

/// lambda with sum lambda_i n_i nearest to `v`. The normals must be independent.
[[nodiscard]] std::vector<double> coefficients(const std::vector<glm::dvec3>& normals, const glm::dvec3& v);
/// lambda with n_k . sum lambda_i n_i = `lengths`[k].
[[nodiscard]] std::vector<double> multipliers(const std::vector<glm::dvec3>& normals,
                                              const std::vector<double>& lengths);

/// m: sum lambda_i with sum lambda_i n_i = `offset` over the planes that hold the hand; |offset| with one,
/// and at least that.
[[nodiscard]] double loadOf(const HapticOutput& out, const glm::dvec3& offset);

} // namespace touchstone::test
