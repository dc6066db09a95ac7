#pragma once
// A point proxy on the triangles along a path: the penetration of a hand on that path.

#include "devices/surface/near_triangles.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Zilles and Salisbury's god-object (1995): it follows the hand and passes through no triangle. Planning
/// needs its own because `devices/` does not depend on `haptics/`; the tests compare both. Where a tick
/// exhausts its budget of moves the proxy stays, so its depth is an upper bound.
class SurfaceProxy {
  public:
    /// `gap`: m between the proxy and what it touches, far less than any depth of interest.
    SurfaceProxy(const NearTriangles& triangles, const glm::dvec3& place, double gap)
        : triangles_(&triangles), place_(place), gap_(gap) {}

    /// Moves the proxy towards `hip` as far as the surface allows.
    void follow(const glm::dvec3& hip);
    /// Places the proxy where the straight line is free, or where the surface is known to be.
    void put(const glm::dvec3& place) { place_ = place; }
    [[nodiscard]] const glm::dvec3& place() const { return place_; }
    /// In the last `follow`.
    [[nodiscard]] bool touches() const { return touches_; }

  private:
    struct Hit {
        double fraction = 2.0;  ///< of the way; over 1: nothing is hit
        double height = 0.0;    ///< m of the move's start over the triangle
        glm::dvec3 normal{0.0}; ///< unit, towards the start
    };
    [[nodiscard]] Hit firstAlong(const glm::dvec3& way) const;

    const NearTriangles* triangles_;
    glm::dvec3 place_;
    double gap_; ///< m
    bool touches_ = false;
};

} // namespace touchstone
