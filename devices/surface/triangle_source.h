#pragma once
// The triangles that a stroke is planned on, one at a time.

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace touchstone {

struct Scene;

/// m, device frame.
struct SurfaceTriangle {
    glm::dvec3 a{0.0}, b{0.0}, c{0.0};
    uint32_t object = 0; ///< of the scene's instances
    /// 0: both sides are tangible. Else only one is: that to which front * cross(b - a, c - a) points.
    int front = 0;

    /// Whether it is tangible from `towards`, a direction out of the surface.
    [[nodiscard]] bool feltFrom(const glm::dvec3& towards) const {
        return front == 0 || front * glm::dot(glm::cross(b - a, c - a), towards) > 0.0;
    }
};

using TriangleVisitor = std::function<void(const SurfaceTriangle&)>;
/// Calls its visitor with every triangle, always in the same order. Triangles that share a corner have
/// identical bits for it.
using TriangleSource = std::function<void(const TriangleVisitor&)>;

/// The triangles of `scene` (rest pose) as `deviceFromScene` places them. The scene outlives it.
[[nodiscard]] TriangleSource trianglesOf(const Scene& scene, const Similarity& deviceFromScene);
/// Triangles given by their corners, three each, in the device frame; the corners outlive it.
[[nodiscard]] TriangleSource trianglesOf(std::span<const glm::dvec3> corners);
/// The triangles of a list that outlives it.
[[nodiscard]] TriangleSource trianglesOf(std::span<const SurfaceTriangle> triangles);

[[nodiscard]] Bounds boundsOf(const TriangleSource& triangles);

/// The triangles that meet the cube of `half` m to each side of `centre`.
[[nodiscard]] std::vector<SurfaceTriangle> trianglesNear(const TriangleSource& triangles,
                                                         const glm::dvec3& centre, double half);

} // namespace touchstone
