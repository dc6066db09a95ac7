// The numbers of tools/figure_finger: [004 Figs. 2, 5, 6] from the code that is felt. Blocks, each after its
// name in a comment; lengths in mm.

#include "haptics/finger/planar_touch.h"

#include <cmath>
#include <cstdio>
#include <tuple>

namespace touchstone {
namespace {

void print(const glm::dvec2& point) {
    std::printf("%.6f %.6f\n", 1e3 * point.x, 1e3 * point.y);
}

void block(const char* name) {
    std::printf("\n\n# %s\n", name);
}

/// The point of tangency on the curve: de Casteljau's second step [004 eq. 2].
glm::dvec2 onCurve(const Polyline::Patch& patch, double t) {
    const glm::dvec2 p12 = patch.p1 + t * (patch.p2 - patch.p1), p23 = patch.p2 + t * (patch.p3 - patch.p2);
    return p12 + t * (p23 - p12);
}

/// Fig. 2: contact location over travel, the same path over a smooth arc, over one vertex of as much turn,
/// and over the polygon of 12 segments with tactile shading.
void locations() {
    const SmoothArc arc{.radius = 0.05, .angle = 0.8};
    const PlanarSurface smooth{arc}, facets(polygonOf(arc, 6));
    const PlanarRendering plain{.location = PlanarLocation::Facets},
        shaded{.location = PlanarLocation::Bezier, .step = TangentStep::Solved};
    const ArcFinger finger;
    for (const auto& [name, surface, rendering] :
         {std::tuple{"Fig. 2: smooth", &smooth, &plain}, std::tuple{"Fig. 2: facets", &facets, &plain},
          std::tuple{"Fig. 2: tactile shading", &facets, &shaded}}) {
        block(name);
        PlanarTouch touch(*surface, *rendering, finger);
        for (double at = -0.36; at <= 0.36; at += 1e-3) {
            const glm::dvec2 normal(std::sin(at), std::cos(at));
            const glm::dvec2 centre = arc.centre() + (arc.radius + finger.radius - 0.001) * normal;
            std::printf("%.6f %.6f\n", 1e3 * arc.radius * at,
                        1e3 * touch.step({.pad = centre - glm::dvec2(0.0, finger.radius)}).location);
        }
    }
}

/// Fig. 5: a polygon, its curve, the local centres with the midpoints and vertex of their patches. Fig. 6:
/// tangents at t = 0.25, 0.5, 0.75 of each vertex.
void curve() {
    const std::vector<glm::dvec2> points{{0.0, 0.0},     {0.004, 0.020},  {0.022, 0.031},
                                         {0.041, 0.024}, {0.050, 0.036},  {0.071, 0.034},
                                         {0.078, 0.010}, {0.060, -0.006}, {0.030, 0.002}};
    const Polyline line(points, true);
    block("Fig. 5: polygon");
    for (size_t i = 0; i <= points.size(); ++i)
        print(points[i % points.size()]);
    block("Fig. 5: curve");
    for (const Polyline::Patch& patch : line.patches())
        for (int i = 0; i <= 20; ++i)
            print(onCurve(patch, 0.05 * i));
    block("Fig. 5: regions");
    for (const Polyline::Patch& patch : line.patches()) {
        for (const glm::dvec2& corner : {patch.centre, patch.p1, patch.p2, patch.p3, patch.centre})
            print(corner);
        std::printf("\n");
    }
    block("Fig. 5: centres");
    for (const Polyline::Patch& patch : line.patches())
        print(patch.centre);
    block("Fig. 6: tangents");
    for (size_t i = 0; i < line.patches().size(); ++i)
        for (const double t : {0.25, 0.5, 0.75}) {
            const SurfaceLine tangent = line.tangent(static_cast<double>(i) + t);
            const glm::dvec2 along(tangent.normal.y, -tangent.normal.x), at = onCurve(line.patches()[i], t);
            print(at - 0.005 * along);
            print(at + 0.005 * along);
            std::printf("\n");
        }
}

} // namespace
} // namespace touchstone

int main() {
    touchstone::locations();
    touchstone::curve();
    return 0;
}
