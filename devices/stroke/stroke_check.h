#pragma once
// Whether a stroke keeps to its depth: walks a proxy along the whole path, before anybody plays it.

#include "devices/stroke/stroke_path.h"
#include "devices/surface/near_triangles.h"
#include "devices/surface/surface_proxy.h"

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace touchstone {

/// A hand is never farther from its proxy than this times the depth that was asked for.
inline constexpr double kDepthFactor = 1.5;

/// The triangles that a hand on `path`, pressed in by `depth` m, can meet. One pass through all.
[[nodiscard]] NearTriangles trianglesAlong(const TriangleSource& triangles, const StrokePath& path,
                                           double depth);

/// Goes along one period of a path. In steps of a tenth of the depth in touch and less where it is deep;
/// between two samples the hand is deeper than at either by less than a step.
class StrokeWalk {
  public:
    /// `keepOut`: boxes into which the hand must not come at all; they outlive it.
    StrokeWalk(const NearTriangles& triangles, const StrokePath& path, double depth,
               std::span<const Bounds> keepOut = {});

    /// The time (s) at which the hand is too deep or where it must not be, next after where the walk is;
    /// null: it never is.
    [[nodiscard]] std::optional<double> nextFault();
    /// Goes on from `time` with the proxy at `place`.
    void resume(double time, const glm::dvec3& place);
    /// So far: it has been pressed in by a third of the depth.
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

/// The path presses the surface and nowhere deeper than it may; over `triangles` that hold all that is near.
[[nodiscard]] bool strokeHolds(const TriangleSource& triangles, const StrokePath& path, double depth,
                               std::span<const Bounds> keepOut = {});

/// Whether `p` is in one of the boxes or within `margin` m of it.
[[nodiscard]] bool isInAny(std::span<const Bounds> boxes, const glm::dvec3& p, double margin);

/// Whether `point` may be inside a closed object: what begins there feels nothing. `out`: the direction in
/// which the way is most likely free.
[[nodiscard]] bool maybeInside(const TriangleSource& triangles, const glm::dvec3& point,
                               const glm::dvec3& out);

} // namespace touchstone
