#pragma once
// Single points where a hand can press a model on which no stroke fits.

#include "devices/surface/triangle_source.h"
#include "engine/core/error.h"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

/// m: no stroke is laid on a part so small that it would be less deep. (A part of 1e-26 m took two minutes:
/// no step of a walk along its path moved on in time.)
inline constexpr double kLeastDepth = 1e-6;

/// A hand hovers over `point` and presses it against `normal`.
struct PressPlace {
    glm::dvec3 point{0.0};  ///< m, on the surface
    glm::dvec3 normal{0.0}; ///< unit, out of a tangible side
    double hover = 0.0;     ///< m over the surface, in the air
    double depth = 0.0;     ///< m under it
};

/// Centroids of triangles: first those that lie farthest out in 14 directions and face them, then the
/// largest; each from its tangible sides. Two passes at most; empty where no triangle has an area.
[[nodiscard]] std::vector<PressPlace> pressPlaces(const TriangleSource& triangles, const Bounds& bounds,
                                                  const glm::dvec3& front);

/// The first of `places` at which `holds` with the triangles near it, tried with less hover (of `hover` m)
/// and then with less depth (of `depth` m): between two sheets a hand has little room, and at the bottom of a
/// groove its proxy is farther away than the surface is deep.
[[nodiscard]] std::optional<PressPlace>
firstPress(const TriangleSource& triangles, std::span<const PressPlace> places, double hover, double depth,
           const std::function<bool(const PressPlace&, const TriangleSource& near)>& holds);

/// Whether there is surface on all sides of the point: on the border of an open sheet, contact depends on
/// rounding.
[[nodiscard]] bool isSupported(const TriangleSource& near, const PressPlace& place);

/// The Error of a stroke on a model without a triangle of positive area, or without one that a hand can
/// press.
[[nodiscard]] Error noPlaceToPress(const TriangleSource& triangles);

} // namespace touchstone
