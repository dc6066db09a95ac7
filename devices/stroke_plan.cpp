// How a hand that knows nothing of a model finds its way over it (declared in stroke_path.h).

#include "devices/stroke_path.h"
#include "devices/surface_probe.h"
#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace touchstone {

namespace {

using Hits = std::vector<std::optional<SurfaceHit>>;

// The ellipse follows the bounds at 70 % of their half extent, which is the crest of the doughnut of the
// seeds (60 of 85 mm) and stays on a sphere's front; three waves of 12 % make the stroke cross crests and
// curvature.
constexpr double kEllipse = 0.70, kWave = 0.12;
constexpr int kWaves = 3;
constexpr double kLargestHalfAxis = 0.5; ///< m: what is larger is stroked near its middle only
constexpr double kWorthwhile = 0.3; ///< share of the ellipse over the model that ends the search for a side
constexpr double kHardlyAnything = 0.05; ///< share below which single triangles are pressed instead
constexpr double kStep = 0.2;            ///< of the spacing: what neighbours may differ from their planes
constexpr double kHop = 0.003;           ///< m above the higher side of a step or gap
constexpr double kDeepest = 0.1;         ///< of the model's diagonal: a small model is not pierced

struct Stroke {
    View view;
    Hits hits;                 ///< none where there is nothing
    std::vector<double> walls; ///< height of one beside the hit, which the hand keeps off; else -infinity
    double spacing = 0.0;      ///< m between neighbouring points of the ellipse, at most
    size_t touching = 0;

    /// The hit at i, counted around the ellipse, if it may be touched.
    [[nodiscard]] const SurfaceHit* touchable(size_t i) const {
        const size_t at = i % hits.size();
        return hits[at] && !std::isfinite(walls[at]) ? &*hits[at] : nullptr;
    }
    [[nodiscard]] double share() const {
        return hits.empty() ? 0.0 : static_cast<double>(touching) / static_cast<double>(hits.size());
    }
};

std::vector<glm::dvec2> wavyEllipse(const View& view, double spacing) {
    const double a = std::min(view.half.x, kLargestHalfAxis), b = std::min(view.half.y, kLargestHalfAxis);
    const double longest = 2.0 * std::numbers::pi * std::max(a, b);
    const auto count = static_cast<size_t>(std::max(64.0, std::ceil(longest / spacing)));
    std::vector<glm::dvec2> points;
    for (size_t i = 0; i < count; ++i) {
        // Clockwise from the top, as one would wipe a plate.
        const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
        const double radius = kEllipse + kWave * std::sin(kWaves * angle);
        points.emplace_back(radius * a * std::sin(angle), radius * b * std::cos(angle));
    }
    return points;
}

Stroke strokeFrom(const TriangleSource& triangles, const Bounds& bounds, const glm::dvec3& front,
                  double spacing, double depth) {
    Stroke stroke;
    stroke.view = viewOf(bounds, front);
    const std::vector<glm::dvec2> points = wavyEllipse(stroke.view, spacing);
    stroke.hits = probe(triangles, stroke.view, points);
    // The hand is up to `depth` beside the point that it touches, and goes on by `spacing`.
    stroke.walls = wallsBeside(triangles, stroke.view, points, stroke.hits, depth + spacing);
    stroke.spacing = spacing;
    for (size_t i = 0; i < points.size(); ++i)
        stroke.touching += stroke.touchable(i) != nullptr;
    return stroke;
}

/// The side that was asked for if the model offers enough there, else the side that offers most.
Stroke bestStroke(const TriangleSource& triangles, const Bounds& bounds, const StrokeOptions& options,
                  double depth) {
    const double spacing = options.speed * StrokePath::kKnotInterval;
    const std::array<glm::dvec3, 7> fronts{
        glm::normalize(options.front), glm::dvec3(0, 1, 0),  glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0),
        glm::dvec3(-1, 0, 0),          glm::dvec3(0, 0, -1), glm::dvec3(0, -1, 0)};
    Stroke best;
    for (const glm::dvec3& front : fronts) {
        Stroke stroke = strokeFrom(triangles, bounds, front, spacing, depth);
        if (stroke.share() > best.share())
            best = std::move(stroke);
        if (best.share() >= kWorthwhile)
            break;
    }
    return best;
}

/// Down onto the first touching point, along all of them, through the air over gaps, steps and walls, and up.
///
/// A hand that does not yield must not go through a step: 1 mm under the upper side it would be far inside
/// the wall, and the proxy would rightly stay at the foot of it, where the force grows without bound.
std::vector<glm::dvec3> waypointsAlong(const Stroke& stroke, double depth, double clearance) {
    const size_t count = stroke.hits.size();
    const View& view = stroke.view;
    // Begin behind a gap if there is one, so that no touching run is cut in two.
    size_t start = 0;
    for (size_t i = 0; i < count; ++i)
        if (!stroke.touchable(i + count - 1) && stroke.touchable(i))
            start = i;

    const auto raised = [&](const glm::dvec3& place, double height) {
        const glm::dvec3 viewed = view.viewed(place);
        return view.point({viewed.x, viewed.y, height});
    };
    const double top = view.half.z + clearance;
    std::vector<glm::dvec3> waypoints;
    const SurfaceHit* last = nullptr;
    double highest = 0.0; // of what lies between the last touch and this one
    bool skipped = false;
    for (size_t i = start; i < start + count; ++i) {
        if (const auto& any = stroke.hits[i % count])
            highest = std::max({highest, view.viewed(any->point).z, stroke.walls[i % count]});
        const SurfaceHit* hit = stroke.touchable(i);
        if (hit == nullptr) {
            skipped = true;
            continue;
        }
        const glm::dvec3 pressed = hit->point - depth * hit->normal;
        if (last == nullptr) {
            waypoints.push_back(raised(pressed, top));
        } else if (skipped || breaksOff(view, *last, *hit, kStep * stroke.spacing)) {
            waypoints.push_back(raised(waypoints.back(), highest + kHop));
            waypoints.push_back(raised(pressed, highest + kHop));
        }
        waypoints.push_back(pressed);
        last = hit;
        highest = view.viewed(hit->point).z;
        skipped = false;
    }
    waypoints.push_back(raised(waypoints.back(), top));
    return waypoints;
}

/// For models that hardly show a surface from any side: from six directions, each beside the one before, down
/// to the triangle that lies furthest out there. Nothing is in the way, since nothing lies further out.
std::vector<glm::dvec3> pressesFromAround(const TriangleSource& triangles, const Bounds& bounds, double depth,
                                          double clearance) {
    constexpr std::array<glm::dvec3, 6> kDirections{glm::dvec3(0, 0, 1),  glm::dvec3(1, 0, 0),
                                                    glm::dvec3(0, 1, 0),  glm::dvec3(0, 0, -1),
                                                    glm::dvec3(-1, 0, 0), glm::dvec3(0, -1, 0)};
    std::array<std::optional<glm::dvec3>, 6> furthest;
    triangles([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        if (!(glm::length(glm::cross(b - a, c - a)) > 0.0))
            return;
        const glm::dvec3 middle = (a + b + c) / 3.0;
        for (size_t i = 0; i < kDirections.size(); ++i)
            if (!furthest[i] || glm::dot(middle - *furthest[i], kDirections[i]) > 0.0)
                furthest[i] = middle;
    });
    std::vector<glm::dvec3> waypoints;
    if (!furthest[0])
        return waypoints;
    const double outside = 0.5 * bounds.diagonal() + clearance;
    for (size_t i = 0; i < kDirections.size(); ++i) {
        const glm::dvec3 &direction = kDirections[i], next = kDirections[(i + 1) % kDirections.size()];
        const glm::dvec3 hover = *furthest[i] + outside * direction;
        waypoints.push_back(hover);
        waypoints.push_back(*furthest[i] - depth * direction);
        waypoints.push_back(hover);
        waypoints.push_back(bounds.centre() + 1.5 * outside * glm::normalize(direction + next));
    }
    return waypoints;
}

StrokePath plan(const TriangleSource& triangles, const StrokeOptions& options) {
    Bounds bounds;
    triangles([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        bounds.include(a);
        bounds.include(b);
        bounds.include(c);
    });
    const double depth = bounds.empty() ? 0.0 : std::min(options.depth, kDeepest * bounds.diagonal());
    std::vector<glm::dvec3> waypoints;
    if (!bounds.empty()) {
        const Stroke stroke = bestStroke(triangles, bounds, options, depth);
        waypoints = stroke.share() >= kHardlyAnything
                        ? waypointsAlong(stroke, depth, options.clearance)
                        : pressesFromAround(triangles, bounds, depth, options.clearance);
    }
    if (waypoints.empty())
        throw Error("simulated hand", "", "the model has no surface that could be touched",
                    "open a model with triangles that are not all of zero area");
    return StrokePath::around(waypoints, options.speed);
}

} // namespace

StrokePath strokeOver(const Scene& scene, const Similarity& deviceFromScene, const StrokeOptions& options) {
    return plan(trianglesOf(scene, deviceFromScene), options);
}

StrokePath strokeOver(std::span<const glm::dvec3> corners, const StrokeOptions& options) {
    return plan(trianglesOf(corners), options);
}

} // namespace touchstone
