#pragma once
// The world of the contact location display [004 §4.1]: a polyline in the plane, with the curve that tactile
// shading makes of it.

#include "haptics/finger/arc_finger.h"

#include <cstddef>
#include <span>
#include <vector>

namespace touchstone {

/// Solid on the right of its direction, free on the left; a closed one runs clockwise around its solid. Read
/// by any thread, unchanging.
class Polyline {
  public:
    /// Points in m. Points that follow one another at one place are taken once. Throws Error, with a remedy,
    /// where fewer than two places are left (three of a closed line), a coordinate lies beyond 1000 km, or
    /// the line turns back on itself at a point (a spike has no tangent).
    Polyline(std::span<const glm::dvec2> points, bool closed);

    [[nodiscard]] bool closed() const noexcept { return closed_; }
    [[nodiscard]] std::span<const glm::dvec2> points() const noexcept { return points_; }
    [[nodiscard]] size_t edgeCount() const noexcept { return edges_.size(); }
    /// The line along an edge.
    [[nodiscard]] SurfaceLine edge(size_t index) const noexcept;

    /// A vertex with the halves of its two edges: one quadratic Bezier patch [004 Fig. 7].
    struct Patch {
        glm::dvec2 p1, p2, p3;   ///< midpoint, vertex, midpoint
        glm::dvec2 centre{0.0};  ///< local centre of the radial parameterisation
        bool straight = false;   ///< the edges are in line: the centre lies at infinity
        double toVertex = 0.0;   ///< angle from p1 to p2 about the centre, rad, signed; m if straight
        double fromVertex = 0.0; ///< from p2 to p3
    };
    /// One for each vertex with two edges; none where an open line has two points.
    [[nodiscard]] std::span<const Patch> patches() const noexcept { return patches_; }

    /// Where the line of a place `u` = patch + t is, 0 <= t <= 1: p12 p23 of de Casteljau's construction
    /// [004 eq. 1]. Beyond the ends of an open line: the first or last edge.
    [[nodiscard]] SurfaceLine tangent(double u) const noexcept;
    /// The place on the curve that `point` projects to from the local centre of its patch [004 eqs. 3, 4],
    /// sought from the patch of `u` on, at most kMostSwitches patches away. A closed line goes around without
    /// end: u may leave [0, patches).
    [[nodiscard]] double project(double u, const glm::dvec2& point) const noexcept;

    /// The edge into which the finger reaches deepest, if that is deeper than `than` (m, negative where
    /// nothing is touched). Edges whose free side the finger's centre is not on do not count, nor do those of
    /// the patch `apartFrom`.
    struct Deepest {
        size_t edge = 0;
        double depth = 0.0;
        bool found = false;
    };
    [[nodiscard]] Deepest deepest(const ArcFinger& finger, const FingerPose& pose, double than,
                                  long apartFrom = -1) const noexcept;
    /// The depth to which the finger reaches into the edges of a patch, as deepest() sees them.
    [[nodiscard]] double depthOf(long patch, const ArcFinger& finger, const FingerPose& pose) const noexcept;
    /// The patch of a place; not where there is none.
    [[nodiscard]] size_t patchOf(double u) const noexcept;
    /// The place u in the middle of an edge.
    [[nodiscard]] double middleOf(size_t edge) const noexcept;

    static constexpr int kMostSwitches = 64;

  private:
    struct Edge {
        glm::dvec2 from, to, normal;
        double length;
    };

    [[nodiscard]] bool belongsTo(size_t edge, long patch) const noexcept;
    [[nodiscard]] static double depthIn(const Edge& edge, const ArcFinger& finger, const FingerPose& pose,
                                        const glm::dvec2& centre) noexcept;
    /// t of the point on a patch; below 0 or above 1 outside of it.
    [[nodiscard]] static double parameter(const Patch& patch, const glm::dvec2& point) noexcept;

    std::vector<glm::dvec2> points_;
    std::vector<Edge> edges_;
    std::vector<Patch> patches_;
    bool closed_;
};

} // namespace touchstone
