#pragma once
// The surface as the judge of the hard cases sees it: every welded triangle, without any search tree, in long
// double. What the geometry demands of a force is computed here and nowhere else.

#include "haptics/scene/haptic_scene.h"
#include "study/truth/brute_force.h"

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace touchstone::test {

using namespace truth;

/// What lies within reach of a proxy; workspace frame.
struct Touching {
    std::vector<uint64_t> triangles; ///< object << 32 | triangle, sorted
    std::vector<glm::dvec3> normals; ///< unit, from the surface to the proxy
    std::vector<glm::dvec3> felt;    ///< what the vertex normals give there; the same as `normals` where flat
    double nearest = INFINITY;       ///< m, of any triangle, if within reach
    [[nodiscard]] double tilt() const; ///< rad, largest angle between `normals` and `felt`
};

class Surface {
  public:
    /// `shaded`: the tilt limit of the shading in rad, 0 without.
    Surface(const HapticScene& scene, double shaded);

    /// All triangles within `reach` (m) of `p`; `motions` as in TickInput.
    [[nodiscard]] Touching touching(ObjectMotions motions, const glm::dvec3& p, double reach) const;

    /// By how much the free sector round each edge nearer than `reach` (m) to the way from p to q exceeds
    /// half a turn, rad: positive at a convex edge as seen from the way, negative at a concave one, zero
    /// where the surface goes straight on, pi where it ends. Triangles nearer to an edge than `gap` (m)
    /// continue the surface there. Looks no further once the convex ones turn by `enough`.
    [[nodiscard]] std::vector<double> edgesAlong(ObjectMotions motions, const glm::dvec3& p,
                                                 const glm::dvec3& q, double reach, double gap,
                                                 double enough = INFINITY) const;
    /// The sum over the convex ones, at most pi: what a surface turns by along the way.
    [[nodiscard]] double turnAlong(ObjectMotions motions, const glm::dvec3& p, const glm::dvec3& q,
                                   double reach, double gap) const;

  private:
    struct Ball {
        glm::dvec3 centre;
        double radius;
    };
    /// Whether the ball around a triangle is farther away than `reach`.
    [[nodiscard]] bool isBeyond(size_t object, size_t triangle, const glm::dvec3& at, double reach) const;
    [[nodiscard]] glm::dvec3 feltNormal(size_t object, size_t triangle, const glm::dvec3& closest,
                                        const glm::dvec3& normal) const;
    [[nodiscard]] double freeSector(size_t object, const std::vector<size_t>& near, const glm::dvec3& at,
                                    const glm::dvec3& along, const glm::dvec3& seenFrom, double gap) const;
    [[nodiscard]] double stepAt(size_t object, const std::vector<size_t>& near,
                                std::pair<uint32_t, uint32_t> edge, const glm::dvec3& at, double gap) const;

    const HapticScene& scene_;
    double tiltLimit_;
    std::vector<std::vector<Ball>> balls_; ///< per object and triangle, object frame
};

/// rad, largest angle between any of `a` and any of `b`; pi where one of them is empty and the other is not.
[[nodiscard]] double largestAngle(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b);
[[nodiscard]] double angleBetween(const glm::dvec3& a, const glm::dvec3& b); ///< rad, of unit vectors

} // namespace touchstone::test
