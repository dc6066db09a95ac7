#pragma once
// Paths on which a simulated hand strokes an arbitrary model.

#include "devices/stroke/path_motion.h"
#include "devices/surface/triangle_source.h"
#include "engine/math/similarity.h"
#include "engine/scene/scene.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

/// Parameters of the tour (strokeOver); lengths in m of the device frame.
struct StrokeOptions {
    double speed = 0.1; ///< m/s along the path and its bound. People explore texture at 0.02..0.2 m/s.
    double depth =
        0.001; ///< m below the surface, along its normal. 1 mm at 600 N/m is 0.6 N, a light finger.
    double clearance = 0.01; ///< m above the model's highest point while not in contact
    /// Side from which the hand comes, unit: towards the viewer. Another side of the box is used where the
    /// model shows nothing from there (a sheet seen edge-on).
    glm::dvec3 front{0.0, 0.0, 1.0};
};

/// A closed path: a uniform cubic B-spline, so position, velocity and acceleration are continuous. The speed
/// nowhere exceeds the given one: the velocity is a convex combination of the chords between control points,
/// whose length is at most speed times their interval. It cuts corners by less than a control interval.
/// Immutable; `position` and `velocity` may be called from any thread and do not allocate.
class StrokePath {
  public:
    /// s between control points of `around`; at 0.1 m/s they are 1 mm apart.
    static constexpr double kKnotInterval = 0.010;
    static constexpr double kLongest = 12 * 3600.0; ///< s of a path of `around`: 100 MB of control points

    /// Along the closed polygon of `waypoints` at `speed`, periodic. Throws Error without a finite waypoint,
    /// and where one period exceeds kLongest.
    [[nodiscard]] static StrokePath around(std::span<const glm::dvec3> waypoints, double speed);

    /// Through the neighbourhood of `control`, at steps of `interval` s, periodic: each point is passed
    /// within a sixth of its second difference. Throws Error without a finite point or interval. `place`: the
    /// point on the surface where it is laid.
    [[nodiscard]] static StrokePath through(std::vector<glm::dvec3> control, double interval,
                                            const glm::dvec3& place);

    [[nodiscard]] glm::dvec3 position(double time) const noexcept; ///< m, device frame; time in s
    [[nodiscard]] glm::dvec3 velocity(double time) const noexcept; ///< m/s
    /// The same path for a hand that moves with a part of the scene. Null: static.
    [[nodiscard]] StrokePath carriedBy(std::shared_ptr<const PathMotion> motion) const {
        StrokePath path = *this;
        path.motion_ = std::move(motion);
        return path;
    }
    /// The path on which a hand is where `place` takes it: from the share of the period and the position
    /// then.
    [[nodiscard]] StrokePath moved(const std::function<glm::dvec3(double, const glm::dvec3&)>& place) const;
    /// Position of the hand at `time` of the path and `sceneTime` of the animation; position(time) on a
    /// static part.
    [[nodiscard]] glm::dvec3 positionIn(double time, double sceneTime) const noexcept {
        return motion_ == nullptr ? position(time) : motion_->at(time / period(), sceneTime, position(time));
    }
    /// m: the fixed point when the hand's workspace is zoomed; of a tour, its start.
    [[nodiscard]] const glm::dvec3& place() const { return place_; }
    [[nodiscard]] double period() const { return interval_ * static_cast<double>(control_.size()); } ///< s

  private:
    StrokePath(std::vector<glm::dvec3> control, double interval, const glm::dvec3& place)
        : control_(std::move(control)), interval_(interval), place_(place) {}
    [[nodiscard]] const glm::dvec3& control(size_t knot, size_t offset) const noexcept {
        return control_[(knot + offset) % control_.size()];
    }
    std::vector<glm::dvec3> control_;
    double interval_; // s
    glm::dvec3 place_;
    std::shared_ptr<const PathMotion> motion_;
};

/// A stroke over any `scene` (static pose), placed by `deviceFromScene`: from above the model down onto it,
/// `depth` below its surface around a wavy ellipse on the side that faces `front`, then off again. The hand
/// hops over gaps, steps and walls however low: it does not yield, and a proxy caught behind one would pull
/// it with growing force. Where no such ellipse meets the model (wires, sparse parts), it presses single
/// triangles one after the other. The hand is nowhere farther than 1.5 times the depth from a point proxy
/// that follows it: violations are repaired or left out. Owner thread; time grows with the triangles (about
/// 0.1 s per million). Throws Error when there is no triangle to touch, or no point that can be pressed
/// without going deeper.
[[nodiscard]] StrokePath strokeOver(const Scene& scene, const Similarity& deviceFromScene,
                                    const StrokeOptions& options = {});
/// The same over triangles given by their corners, three each, in the device frame.
[[nodiscard]] StrokePath strokeOver(std::span<const glm::dvec3> corners, const StrokeOptions& options = {});
/// What becomes of a path, `depth` m deep, that holds on the surface at rest; nullopt: it does not hold while
/// the surface moves.
using CarryPath = std::function<std::optional<StrokePath>(const StrokePath& path, double depth)>;
/// The same over any triangles, by a hand that avoids the boxes of `keepOut`. `carry`: empty for a path that
/// stays as it is; else the ellipse alone is tried, and no press.
[[nodiscard]] StrokePath strokeOver(const TriangleSource& triangles, const StrokeOptions& options,
                                    std::span<const Bounds> keepOut, const CarryPath& carry = {});

} // namespace touchstone
