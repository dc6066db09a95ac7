#pragma once
// What a hand should feel on its way: the truth of a whole path, once for all rungs that are compared with
// it.

#include "study/truth/smooth_shape.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace touchstone {
class HapticScene;
}

namespace touchstone::truth {

/// One tick, felt or as it should be felt. Workspace; m, N.
struct FeltTick {
    glm::dvec3 proxy{0.0}, force{0.0};
    bool contact = false;
    bool failed = false; ///< no truth is known of this tick
};

/// The frictionless proxy of `radius` for each HIP; the first one is free.
struct RestPath {
    std::vector<glm::dvec3> proxies, normals; ///< normals: zero without contact
    std::vector<bool> failed;
};

/// On the smooth shape.
[[nodiscard]] RestPath smoothPath(const SmoothShape& shape, std::span<const glm::dvec3> hips, double radius);

/// On the mesh, by the oracle: it goes on from its own last rest, sees every triangle of the scene at rest
/// and has no budget but `moves` over the whole path; ticks beyond are failed. Any thread.
[[nodiscard]] RestPath oraclePath(const HapticScene& scene, std::span<const glm::dvec3> hips, double radius,
                                  size_t moves);

/// The force of a spring of `stiffness`, N/m, from the HIP to the proxy, and Coulomb's friction at
/// `friction` times the load against the way that the proxy takes: rigid, so that a sliding hand feels it in
/// full from its first tick. 0: none.
[[nodiscard]] std::vector<FeltTick> springForces(const RestPath& path, std::span<const glm::dvec3> hips,
                                                 double stiffness, double friction);

} // namespace touchstone::truth
