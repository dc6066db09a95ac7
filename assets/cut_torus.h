#pragma once
// A torus that was cut open: object 2 of [000 Table I].

#include "assets/shapes.h"

#include <span>

namespace touchstone::assets {

/// Torus about the z axis with circles of `points` vertices about its tube, at equal turns; the last circle
/// is in the place of the first, bit for bit, and shares no vertex with it. So by its indices the surface is
/// an annulus, whose two borders lie on each other: a closed torus, cut open along points.front() edges. It
/// has sum(points) vertices, and a strip between circles of m and n vertices has m + n triangles. Smooth
/// normals. At least four circles of at least three vertices, the last as many as the first.
[[nodiscard]] Shape cutTorus(double ring, double tube, std::span<const uint32_t> points);

/// Object 2 of [000 Table I]: 239 vertices, 695 edges, 456 triangles, 60 mm and 25 mm.
[[nodiscard]] Shape tableOneRing();

} // namespace touchstone::assets
