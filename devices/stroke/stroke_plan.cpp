// Plans a tour over an arbitrary model (declared in stroke_path.h).

#include "devices/stroke/press_place.h"
#include "devices/stroke/stroke_check.h"
#include "devices/stroke/stroke_path.h"
#include "devices/surface/surface_probe.h"
#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

using Hits = std::vector<std::optional<SurfaceHit>>;

// The ellipse covers 70 % of the half extent of the bounds, which is the crest of the doughnut of the seeds
// (60 of 85 mm) and stays on a sphere's front. Three waves of 12 % make the stroke cross crests and
// curvature.
constexpr double kEllipse = 0.70, kWave = 0.12;
constexpr int kWaves = 3;
constexpr double kLargestHalfAxis = 0.5; ///< m: a larger model is stroked near its centre only
constexpr double kWorthwhile = 0.3; ///< fraction of the ellipse over the model that ends the search for a
                                    ///< side
constexpr double kHardlyAnything = 0.05; ///< fraction below which single triangles are pressed instead
constexpr double kHeightStep = 0.2;      ///< of the spacing: tolerance of neighbours' heights to their planes
constexpr double kHop = 0.003;           ///< m above the higher side of a step or gap
constexpr double kDeepestPlanned = 0.1;  ///< of the model's diagonal: limit for small models
constexpr int kRepairs = 16;             ///< repairs of a tour before another side is tried

struct Stroke {
    ProbeView view;
    Hits hits;                 ///< none where there is nothing
    std::vector<double> walls; ///< height of a wall beside the hit, which the hand avoids; else -infinity
    std::vector<bool> overTop; ///< the hop that lands on this hit clears the whole model
    double spacing = 0.0;      ///< m between neighbouring points of the ellipse, at most
    size_t touching = 0;

    /// The hit at i, counted around the ellipse, if it may be touched.
    [[nodiscard]] const SurfaceHit* touchable(size_t i) const {
        const size_t at = i % hits.size();
        return hits[at] && !std::isfinite(walls[at]) ? &*hits[at] : nullptr;
    }
    /// Marks the hit as untouchable, as one beside a wall.
    void keepOff(size_t i) {
        if (touchable(i) == nullptr)
            return;
        walls[i] = view.viewed(hits[i]->point).z;
        --touching;
    }
    [[nodiscard]] double share() const {
        return hits.empty() ? 0.0 : static_cast<double>(touching) / static_cast<double>(hits.size());
    }
};

std::vector<glm::dvec2> wavyEllipse(const ProbeView& view, double spacing) {
    const double a = std::min(view.half.x, kLargestHalfAxis), b = std::min(view.half.y, kLargestHalfAxis);
    const double longest = 2.0 * std::numbers::pi * std::max(a, b);
    const auto count = static_cast<size_t>(std::max(64.0, std::ceil(longest / spacing)));
    std::vector<glm::dvec2> points;
    for (size_t i = 0; i < count; ++i) {
        // Clockwise from the top.
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
    // The hand is up to `depth` beside the point that it touches, and advances by `spacing`.
    stroke.walls = wallsBeside(triangles, stroke.view, points, stroke.hits, depth + spacing);
    stroke.overTop.assign(points.size(), false);
    stroke.spacing = spacing;
    for (size_t i = 0; i < points.size(); ++i)
        stroke.touching += stroke.touchable(i) != nullptr;
    return stroke;
}

std::array<glm::dvec3, 7> frontsOf(const StrokeOptions& options) {
    return {glm::normalize(options.front), glm::dvec3(0, 1, 0),  glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0),
            glm::dvec3(-1, 0, 0),          glm::dvec3(0, 0, -1), glm::dvec3(0, -1, 0)};
}

/// The preferred side if the model offers enough there, else the side that offers most; and its index.
std::pair<Stroke, size_t> bestStroke(const TriangleSource& triangles, const Bounds& bounds,
                                     const StrokeOptions& options, double depth) {
    const double spacing = options.speed * StrokePath::kKnotInterval;
    const auto fronts = frontsOf(options);
    std::pair<Stroke, size_t> best;
    for (size_t i = 0; i < fronts.size(); ++i) {
        Stroke stroke = strokeFrom(triangles, bounds, fronts[i], spacing, depth);
        if (stroke.share() > best.first.share())
            best = {std::move(stroke), i};
        if (best.first.share() >= kWorthwhile)
            break;
    }
    return best;
}

/// A vertex of the tour's polygon.
struct Waypoint {
    glm::dvec3 place{0.0};
    size_t hit = 0;      ///< the hit that it presses, or that it is over
    bool raised = false; ///< in the air
};

/// Down onto the first touched point, along all of them, through the air over gaps, steps and walls, and up.
///
/// A hand that does not yield must not pass through a step: 1 mm under the upper side it would be far inside
/// the wall, and the proxy would correctly stay at the foot of it, where the force grows without bound.
std::vector<Waypoint> waypointsAlong(const Stroke& stroke, double depth, double clearance) {
    const size_t count = stroke.hits.size();
    const ProbeView& view = stroke.view;
    // Start behind a gap if there is one, so that no run of contact is cut in two.
    size_t start = 0;
    for (size_t i = 0; i < count; ++i)
        if (!stroke.touchable(i + count - 1) && stroke.touchable(i))
            start = i;

    const auto raised = [&](const glm::dvec3& place, double height) {
        const glm::dvec3 viewed = view.viewed(place);
        return view.point({viewed.x, viewed.y, height});
    };
    const double top = view.half.z + clearance;
    std::vector<Waypoint> waypoints;
    const SurfaceHit* last = nullptr;
    double highest = 0.0; // between the last touched hit and this one
    bool skipped = false;
    for (size_t k = start; k < start + count; ++k) {
        const size_t i = k % count;
        if (const auto& any = stroke.hits[i])
            highest = std::max({highest, view.viewed(any->point).z, stroke.walls[i]});
        const SurfaceHit* hit = stroke.touchable(i);
        if (hit == nullptr) {
            skipped = true;
            continue;
        }
        const glm::dvec3 pressed = hit->point - depth * hit->normal;
        if (last == nullptr) {
            waypoints.push_back({raised(pressed, top), i, true});
        } else if (skipped || stroke.overTop[i] ||
                   breaksOff(view, *last, *hit, kHeightStep * stroke.spacing)) {
            const double height = stroke.overTop[i] ? top : highest + kHop;
            waypoints.push_back({raised(waypoints.back().place, height), waypoints.back().hit, true});
            waypoints.push_back({raised(pressed, height), i, true});
        }
        waypoints.push_back({pressed, i, false});
        last = hit;
        highest = view.viewed(hit->point).z;
        skipped = false;
    }
    if (last != nullptr)
        waypoints.push_back({raised(waypoints.back().place, top), waypoints.back().hit, true});
    return waypoints;
}

/// Position of a path along the polygon of its waypoints: StrokePath::around places its control points at
/// equal steps along it, and a uniform cubic spline starts at its second control point.
class TourWay {
  public:
    TourWay(std::span<const Waypoint> waypoints, const StrokePath& path) {
        double length = 0.0;
        for (size_t i = 0; i < waypoints.size(); ++i) {
            starts_.push_back(length);
            length += glm::distance(waypoints[i].place, waypoints[(i + 1) % waypoints.size()].place);
        }
        perSecond_ = length / path.period();
        step_ = perSecond_ * StrokePath::kKnotInterval;
    }
    [[nodiscard]] double at(double time) const { return perSecond_ * time + step_; } ///< m
    [[nodiscard]] double timeAt(size_t waypoint) const {                             ///< s
        return (starts_[waypoint] - step_) / perSecond_;
    }
    [[nodiscard]] double step() const { return step_; } ///< m between control points
    /// The last waypoint not beyond arc length `way` m.
    [[nodiscard]] size_t before(double way) const {
        const auto after = std::ranges::upper_bound(starts_, way);
        return after == starts_.begin() ? 0 : static_cast<size_t>(after - starts_.begin()) - 1;
    }
    [[nodiscard]] size_t count() const { return starts_.size(); }

  private:
    std::vector<double> starts_; ///< m, arc length of each waypoint
    double perSecond_ = 0.0, step_ = 0.0;
};

/// Walks along the tour. Where the hand is too deep, the tour avoids the hits around, or hops higher. False:
/// it was nowhere too deep.
bool repaired(Stroke& stroke, std::span<const Waypoint> waypoints, const StrokePath& path, StrokeWalk& walk,
              double depth, int round) {
    const TourWay way(waypoints, path);
    bool faulty = false;
    while (const std::optional<double> fault = walk.nextFault()) {
        faulty = true;
        const double at = way.at(*fault), around = way.step() + (1 + round) * depth;
        const size_t first = way.before(at - around), last = way.before(at + around);
        for (size_t w = first; w <= last; ++w) {
            const Waypoint &from = waypoints[w], &to = waypoints[(w + 1) % waypoints.size()];
            const bool low = from.raised != to.raised || (from.raised && to.raised);
            if (low && from.hit != to.hit && !stroke.overTop[to.hit]) {
                stroke.overTop[to.hit] = true; // the hop is too low
                continue;
            }
            stroke.keepOff(from.hit);
            if (w + 1 < waypoints.size())
                stroke.keepOff(to.hit);
        }
        // Continue from the next waypoint, with the proxy at the hit.
        const size_t next = last + 1;
        if (next >= way.count() || !(way.timeAt(next) > *fault))
            break;
        const Waypoint& waypoint = waypoints[next];
        const SurfaceHit& hit = *stroke.hits[waypoint.hit];
        walk.resume(way.timeAt(next),
                    waypoint.raised ? waypoint.place : hit.point + 1e-3 * depth * hit.normal);
    }
    return faulty;
}

/// What a tour is laid on.
struct TourGround {
    const TriangleSource& triangles;
    Bounds bounds;
    std::span<const Bounds> keepOut; ///< boxes that the hand must not enter
    const CarryPath& carry;

    [[nodiscard]] std::optional<StrokePath> carried(const StrokePath& path, double depth) const {
        return carry ? carry(path, depth) : std::optional(path);
    }
};

/// The tour along a stroke, repaired until it keeps to its depth everywhere. Nullopt where hardly anything is
/// left to touch.
std::optional<StrokePath> heldTour(const TourGround& ground, Stroke stroke, double depth,
                                   const StrokeOptions& options) {
    for (size_t i = 0; i < stroke.hits.size(); ++i)
        if (stroke.hits[i] && isInAny(ground.keepOut, stroke.hits[i]->point, 2.0 * kDepthFactor * depth))
            stroke.keepOff(i);
    for (int round = 0; round < kRepairs && stroke.share() >= kHardlyAnything; ++round) {
        const std::vector<Waypoint> waypoints = waypointsAlong(stroke, depth, options.clearance);
        std::vector<glm::dvec3> places;
        for (const Waypoint& waypoint : waypoints)
            places.push_back(waypoint.place);
        StrokePath path = StrokePath::around(places, options.speed);
        const NearTriangles near = trianglesAlong(ground.triangles, path, depth);
        StrokeWalk walk(near, path, depth, ground.keepOut);
        if (!repaired(stroke, waypoints, path, walk, depth, round))
            return walk.pressed() ? ground.carried(path, depth) : std::nullopt;
    }
    return std::nullopt;
}

/// For models with hardly any surface from any side: presses from six directions, each next to the one
/// before, on the triangle that lies farthest out there. Nothing is in the way, since nothing lies farther
/// out.
std::vector<glm::dvec3> pressesFromAround(const TriangleSource& triangles, const Bounds& bounds, double depth,
                                          double clearance) {
    constexpr std::array<glm::dvec3, 6> kDirections{glm::dvec3(0, 0, 1),  glm::dvec3(1, 0, 0),
                                                    glm::dvec3(0, 1, 0),  glm::dvec3(0, 0, -1),
                                                    glm::dvec3(-1, 0, 0), glm::dvec3(0, -1, 0)};
    std::array<std::optional<glm::dvec3>, 6> furthest;
    triangles([&](const SurfaceTriangle& triangle) {
        const glm::dvec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
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

/// Presses one point repeatedly, where all else fails.
std::optional<StrokePath> pressSomewhere(const TourGround& ground, double depth,
                                         const StrokeOptions& options) {
    const auto pathAt = [&](const PressPlace& at) {
        const std::array<glm::dvec3, 2> ends{at.point + at.hover * at.normal,
                                             at.point - at.depth * at.normal};
        return StrokePath::around(ends, std::min(options.speed, 0.2 * at.depth / StrokePath::kKnotInterval));
    };
    const auto holds = [&](const PressPlace& at, const TriangleSource& near) {
        const StrokePath path = pathAt(at);
        return strokeHolds(near, path, at.depth, ground.keepOut) &&
               !maybeInside(ground.triangles, path.position(0.0), at.normal);
    };
    const std::vector<PressPlace> places =
        pressPlaces(ground.triangles, ground.bounds, glm::normalize(options.front));
    const double hover = std::min(options.clearance, 100.0 * depth); // small models are pressed slowly
    const auto place = firstPress(ground.triangles, places, hover, depth, holds);
    return place ? std::optional(pathAt(*place)) : std::nullopt;
}

std::optional<StrokePath> pathOver(const TourGround& ground, const StrokeOptions& options) {
    const auto& [triangles, bounds, keepOut, carry] = ground;
    const double depth = std::min(options.depth, kDeepestPlanned * bounds.diagonal());
    if (!(depth >= kLeastDepth))
        return std::nullopt;
    const auto [best, side] = bestStroke(triangles, bounds, options, depth);
    if (best.share() >= kHardlyAnything) {
        if (auto path = heldTour(ground, best, depth, options))
            return path;
        const auto fronts = frontsOf(options);
        for (size_t i = 0; i < fronts.size(); ++i)
            if (i != side)
                if (auto path =
                        heldTour(ground, strokeFrom(triangles, bounds, fronts[i], best.spacing, depth), depth,
                                 options))
                    return path;
    }
    if (carry)
        return std::nullopt; // no way around a part that deforms is sure, and other strokes fit better
    const auto presses = pressesFromAround(triangles, bounds, depth, options.clearance);
    if (presses.empty())
        return std::nullopt;
    StrokePath path = StrokePath::around(presses, options.speed);
    if (strokeHolds(triangles, path, depth, keepOut))
        return path;
    return pressSomewhere(ground, depth, options);
}

} // namespace

StrokePath strokeOver(const TriangleSource& triangles, const StrokeOptions& options,
                      std::span<const Bounds> keepOut, const CarryPath& carry) {
    const TourGround ground{triangles, boundsOf(triangles), keepOut, carry};
    if (!ground.bounds.empty())
        if (auto path = pathOver(ground, options))
            return *std::move(path);
    throw noPlaceToPress(triangles);
}

StrokePath strokeOver(const Scene& scene, const Similarity& deviceFromScene, const StrokeOptions& options) {
    return strokeOver(trianglesOf(scene, deviceFromScene), options, {});
}

StrokePath strokeOver(std::span<const glm::dvec3> corners, const StrokeOptions& options) {
    return strokeOver(trianglesOf(corners), options, {});
}

} // namespace touchstone
