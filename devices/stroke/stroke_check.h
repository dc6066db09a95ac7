#pragma once
// Checks the depth of a stroke: walks a proxy along the whole path before it is played.

#include "devices/stroke/stroke_path.h"
#include "devices/surface/near_triangles.h"
#include "devices/surface/surface_proxy.h"

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace touchstone {

/// A hand is never farther from its proxy than this times the given depth.
inline constexpr double kDepthFactor = 1.5;

/// The triangles that a hand on `path`, pressed in by `depth` m, can meet. One pass through all triangles.
[[nodiscard]] NearTriangles trianglesAlong(const TriangleSource& triangles, const StrokePath& path,
                                           double depth);

/// Walks along one period of a path, in steps of a tenth of the depth in contact and less near the limit.
/// Between two samples the hand is deeper than at either by less than a step.
class StrokeWalk {
  public:
    /// `keepOut`: boxes that the hand must not enter; they outlive it.
    StrokeWalk(const NearTriangles& triangles, const StrokePath& path, double depth,
               std::span<const Bounds> keepOut = {});

    /// The next time (s) at which the hand is too deep or in a forbidden box; null: there is none.
    [[nodiscard]] std::optional<double> nextFault();
    /// Continues from `time` with the proxy at `place`.
    void resume(double time, const glm::dvec3& place);
    /// True once the hand has been pressed in by a third of the depth.
    [[nodiscard]] bool pressed() const { return deepest_ > depth_ / 3.0; }

  private:
    void step();

    const StrokePath& path_;
    std::span<const Bounds> keepOut_;
    double depth_; ///< m
    SurfaceProxy proxy_;
    double time_ = 0.0, step_; ///< s; m along the path
    double below_ = 0.0;       ///< m, now
    double deepest_ = 0.0;     ///< m
};

/// Whether the path presses the surface and nowhere exceeds its depth. `triangles` holds all that is near.
[[nodiscard]] bool strokeHolds(const TriangleSource& triangles, const StrokePath& path, double depth,
                               std::span<const Bounds> keepOut = {});

/// Whether `p` is in one of the boxes or within `margin` m of it.
[[nodiscard]] bool isInAny(std::span<const Bounds> boxes, const glm::dvec3& p, double margin);

/// Whether no triangle lies between two places. `triangles` holds those around the line.
[[nodiscard]] bool isFree(const NearTriangles& triangles, const glm::dvec3& from, const glm::dvec3& to);

/// Whether `point` may be inside a closed object: a path that starts there feels nothing. `out`: the
/// direction most likely to be free.
[[nodiscard]] bool maybeInside(const TriangleSource& triangles, const glm::dvec3& point,
                               const glm::dvec3& out);

} // namespace touchstone
