#pragma once
// The truth of a whole path, computed once for all configurations compared with it.

#include "study/truth/smooth_shape.h"

#include <glm/glm.hpp>

#include <functional>
#include <span>
#include <vector>

namespace touchstone {
class HapticScene;
}

namespace touchstone::truth {

/// One tick, as felt or as it should be felt. Workspace; m, N.
struct FeltTick {
    glm::dvec3 proxy{0.0}, force{0.0};
    bool contact = false;
    bool failed = false; ///< no truth is known for this tick
};

/// The frictionless proxy of `radius` for each HIP; the first one is free.
struct RestPath {
    std::vector<glm::dvec3> proxies, normals; ///< normals: zero without contact
    std::vector<bool> failed;
};

/// On the smooth shape.
[[nodiscard]] RestPath smoothPath(const SmoothShape& shape, std::span<const glm::dvec3> hips, double radius);

/// On the mesh, by the oracle, in the frame of one of the scene's objects: the one that is touched most. It
/// continues from its own last result and uses every triangle of the scene at rest. `work` bounds its time:
/// triangles near the hand times moves, summed over the path (10^8 are some 10 s); ticks beyond it fail. Any
/// thread.
[[nodiscard]] RestPath oraclePath(const HapticScene& scene, int frame, std::span<const glm::dvec3> hips,
                                  double radius, size_t work);

/// The force of a spring of `stiffness`, N/m, from the HIP to the proxy, and rigid Coulomb friction of
/// `friction` times the load against the proxy's displacement: a sliding hand feels it in full from its first
/// tick. 0: none.
[[nodiscard]] std::vector<FeltTick> springForces(const RestPath& path, std::span<const glm::dvec3> hips,
                                                 double stiffness, double friction);

/// A bump height over a smooth shape: its height over the lowest point, m, and its slope.
struct BumpAt {
    double height = 0.0;
    glm::dvec3 slope{0.0};
};
using Bump = std::function<BumpAt(const glm::dvec3& place)>;

/// The same without friction, for a bump height that displaces the surface by [000]'s law: with depth d,
/// height H and m the normal n tilted by the slope, k [(d - H) n + H m] where d >= H, else k d m.
[[nodiscard]] std::vector<FeltTick> reliefForces(const RestPath& path, std::span<const glm::dvec3> hips,
                                                 double radius, double stiffness, const Bump& bump);

} // namespace touchstone::truth
