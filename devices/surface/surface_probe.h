#pragma once
// Probes a triangle soup along one direction, to plan a path before the servo starts.

#include "devices/surface/triangle_source.h"
#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

/// An orthographic view of given bounds. Coordinates (right, up, height) are m from the centre of the bounds,
/// height towards the viewer.
struct ProbeView {
    glm::dvec3 centre{0.0};
    glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}, towards{0.0, 0.0, 1.0}; ///< unit, perpendicular
    glm::dvec3 half{0.0}; ///< half the bounds' extent along right, up, towards

    [[nodiscard]] glm::dvec3 point(const glm::dvec3& viewed) const {
        return centre + viewed.x * right + viewed.y * up + viewed.z * towards;
    }
    [[nodiscard]] glm::dvec3 viewed(const glm::dvec3& p) const {
        return {glm::dot(p - centre, right), glm::dot(p - centre, up), glm::dot(p - centre, towards)};
    }
};

/// `towardsViewer`: unit. Up is as near to +y as possible, else to -z.
[[nodiscard]] ProbeView viewOf(const Bounds& bounds, const glm::dvec3& towardsViewer);

struct SurfaceHit {
    glm::dvec3 point;    ///< m
    glm::dvec3 normal;   ///< unit, of the flat triangle, facing the viewer
    uint32_t object = 0; ///< SurfaceTriangle::object
};

/// The first surface under each of `points` (right, up) that is not higher than `ceiling` and is tangible
/// from there. Watertight: a point inside the outline of a surface without holes hits it, on its edges and
/// vertices too. Passes through the triangles once and stores none, so that a model of ten million needs no
/// memory here.
[[nodiscard]] std::vector<std::optional<SurfaceHit>>
probe(const TriangleSource& triangles, const ProbeView& view, std::span<const glm::dvec2> points,
      double ceiling = std::numeric_limits<double>::infinity());

/// For each of `points`, the height of the highest wall within `reach` m of its hit, or minus infinity. A
/// wall is a triangle, however low, that rises beside the surface at over 75 degrees or overhangs it. A proxy
/// that is pressed in does not climb it.
[[nodiscard]] std::vector<double> wallsBeside(const TriangleSource& triangles, const ProbeView& view,
                                              std::span<const glm::dvec2> points,
                                              std::span<const std::optional<SurfaceHit>> hits, double reach);

/// True if the surface is discontinuous between two neighbouring hits: the height of the second relative to
/// the first differs by more than `tolerance` m from both planes and from everything between them (as over a
/// crease).
[[nodiscard]] bool breaksOff(const ProbeView& view, const SurfaceHit& from, const SurfaceHit& to,
                             double tolerance);

} // namespace touchstone
