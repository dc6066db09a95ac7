#pragma once
// The place of a stroke on a model.

#include "devices/stroke/laid_curve.h"
#include "devices/stroke/stroke_library.h"
#include "devices/surface/surface_probe.h"

namespace touchstone {

/// A view onto the place of a stroke: its centre is on the surface, its axis points out of it.
struct StrokeSite {
    ProbeView view;
    double ceiling = 0.0; ///< m over the centre: higher surface belongs to another part of the model
};

/// The surface within 5 mm of a place, seen along its normal.
[[nodiscard]] std::optional<SurfaceHit> hitAt(const TriangleSource& triangles, const StrokePlace& place);

/// At the given place, where the surface is within 5 mm of it; else several near the centre of what faces
/// `front`, where a hand can reach them, the best first; else on the largest triangle. At least one. Throws
/// Error without any triangle of positive area.
[[nodiscard]] std::vector<StrokeSite> sitesOf(const TriangleSource& triangles, const Bounds& bounds,
                                              const StrokeRequest& request);

/// The midpoints of the sharpest convex edges of the model, the sharpest first; of those within a degree, the
/// one that faces `front` most; at most kMaxEdges, 5 mm apart. Corners nearer than 1e-6 of the model's
/// diagonal are welded. Edges of less than 0.2 degrees or shorter than a hundredth of the diagonal do not
/// count.
[[nodiscard]] std::vector<EdgeSite> sharpestEdges(const TriangleSource& triangles, const Bounds& bounds,
                                                  const glm::dvec3& front);
inline constexpr size_t kMaxEdges = 48;

} // namespace touchstone
