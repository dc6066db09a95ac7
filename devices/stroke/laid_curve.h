#pragma once
// A curve drawn in the plane of a view, projected onto the surface below it and pressed in.

#include "devices/surface/surface_probe.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

/// Two surfaces that meet in a convex edge, at one point of it.
struct EdgeSite {
    glm::dvec3 point{0.0};              ///< m, on the edge
    std::array<glm::dvec3, 2> normal{}; ///< of each surface, unit, outwards
    std::array<glm::dvec3, 2> inward{}; ///< away from the edge along each surface, unit, across the edge
};

/// Hand position and outward direction over the arc length of the path under the surface. At least one point.
class LaidCurve {
  public:
    /// A single point, `depth` m under `point`.
    LaidCurve(const glm::dvec3& point, const glm::dvec3& normal, double depth);

    /// The curve through `points` (m, right and up in `view`), `depth` m under the surface, none of which is
    /// higher than `ceiling` (m over the view's centre). Nullopt where it meets a gap, a step or a wall. The
    /// outward direction is smoothed over `soft` m, so that the hand rounds sharp features.
    [[nodiscard]] static std::optional<LaidCurve> over(const TriangleSource& triangles, const ProbeView& view,
                                                       std::span<const glm::dvec2> points, double depth,
                                                       double soft, double ceiling);
    /// A closed curve over an edge: over the first surface, `depth` m under it, straight on past the edge,
    /// down onto the second surface, `reach` m from the edge, and back in the same way. A hand that rounded
    /// the edge below the surface would leave its proxy on the other side. Its middle is half the length.
    [[nodiscard]] static std::optional<LaidCurve>
    acrossEdge(const TriangleSource& triangles, const EdgeSite& site, double reach, double depth);

    [[nodiscard]] double length() const { return lengths_.back(); } ///< m
    /// `lift` m out of the pressed position at arc length `way` m; `way` is clamped to the length, or wraps
    /// where the curve is closed.
    [[nodiscard]] glm::dvec3 at(double way, double lift) const;

  private:
    LaidCurve() = default;

    std::vector<glm::dvec3> pressed_, normals_;
    std::vector<double> lengths_; // m, arc length of each point
    bool closed_ = false;
};

} // namespace touchstone
