#pragma once
// Single places where a hand can press a model that offers no way to stroke it.

#include "devices/surface/triangle_source.h"
#include "engine/core/error.h"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

/// A hand hovers over `point` and presses it against `normal`.
struct PressPlace {
    glm::dvec3 point{0.0};  ///< m, on the surface
    glm::dvec3 normal{0.0}; ///< unit, out of a side that is felt
    double hover = 0.0;     ///< m over the surface, in the air
    double depth = 0.0;     ///< m under it
};

/// Middles of triangles, those that lie farthest out in 14 directions and face them before the largest ones;
/// each from its sides that are felt. Two passes at most; empty where no triangle has an area.
[[nodiscard]] std::vector<PressPlace> pressPlaces(const TriangleSource& triangles, const Bounds& bounds,
                                                  const glm::dvec3& front);

/// The first of `places` at which `holds` with the triangles near it, tried with less hover (of `hover` m)
/// and then with less depth (of `depth` m) where it does not: between two sheets a hand has little room, and
/// at the bottom of a groove its proxy is farther away than the surface is deep.
[[nodiscard]] std::optional<PressPlace>
firstPress(const TriangleSource& triangles, std::span<const PressPlace> places, double hover, double depth,
           const std::function<bool(const PressPlace&, const TriangleSource& near)>& holds);

/// Whether there is surface on all sides of the place: on the border of an open sheet it is a matter of
/// rounding whether a hand meets it.
[[nodiscard]] bool isSupported(const TriangleSource& near, const PressPlace& place);

/// What a stroke throws where there is no triangle of some area, or none that a hand can press.
[[nodiscard]] Error noPlaceToPress(const TriangleSource& triangles);

} // namespace touchstone
