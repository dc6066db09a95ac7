#include "devices/stroke/stroke_place.h"

#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

constexpr double kNear = 0.005;    ///< m: maximum distance of the touched point from the surface
constexpr double kCeiling = 0.005; ///< m over the place: higher surface belongs to another part
constexpr double kAround =
    0.003; ///< m: radius over which the surface's direction is averaged; smaller on small models
constexpr double kAroundOfModel = 0.02; ///< of the diagonal: that radius on small models
constexpr int kCandidates = 400;
constexpr size_t kMaxSites = 8;
constexpr double kSpotsApart = 0.06; ///< of the diagonal
constexpr double kSteep = 2.0; ///< distance from the centre, in half extents, that a surface seen edge-on
                               ///< counts as

/// Sunflower pattern: evenly over the unit disc, the first point at its centre.
glm::dvec2 seed(int i, int count) {
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
    return std::sqrt(static_cast<double>(i) / count) * glm::dvec2(std::cos(turn), std::sin(turn));
}

/// The view onto a hit, along the mean normal of the surface around it.
StrokeSite siteAt(const TriangleSource& triangles, const Bounds& bounds, const SurfaceHit& hit) {
    Bounds point;
    point.include(hit.point);
    const ProbeView flat = viewOf(point, hit.normal);
    const double around = std::min(kAround, kAroundOfModel * bounds.diagonal());
    constexpr int kRing = 24;
    std::vector<glm::dvec2> ring;
    for (int i = 0; i < kRing; ++i)
        ring.push_back(around * seed(i, kRing));
    glm::dvec3 sum(0.0);
    for (const auto& beside : probe(triangles, flat, ring, around))
        if (beside && flat.viewed(beside->point).z > -around)
            sum += beside->normal;
    StrokeSite site{flat, kCeiling};
    if (glm::length(sum) > 0.0)
        site.view = viewOf(point, glm::normalize(sum));
    return site;
}

/// Touchable hits, nearest the centre and facing the viewer first, at a minimum distance from each other.
std::vector<SurfaceHit> hitsFacing(const TriangleSource& triangles, const Bounds& bounds,
                                   const glm::dvec3& front) {
    const ProbeView view = viewOf(bounds, front);
    std::vector<glm::dvec2> points;
    for (int i = 0; i < kCandidates; ++i)
        points.push_back(seed(i, kCandidates) * glm::dvec2(view.half));
    const auto hits = probe(triangles, view, points);
    const double reach = std::min(0.002, kAroundOfModel * bounds.diagonal());
    const auto walls = wallsBeside(triangles, view, points, hits, reach);
    std::vector<std::pair<double, SurfaceHit>> found;
    for (size_t i = 0; i < points.size(); ++i)
        if (hits[i] && !std::isfinite(walls[i]))
            found.emplace_back(glm::length(seed(static_cast<int>(i), kCandidates)) +
                                   kSteep * (1.0 - glm::dot(hits[i]->normal, view.towards)),
                               *hits[i]);
    std::ranges::stable_sort(found, {}, [](const auto& scored) { return scored.first; });
    std::vector<SurfaceHit> best;
    for (const auto& [score, hit] : found) {
        const auto isNear = [&](const SurfaceHit& other) {
            return glm::distance(other.point, hit.point) < kSpotsApart * bounds.diagonal();
        };
        if (best.size() < kMaxSites && std::ranges::none_of(best, isNear))
            best.push_back(hit);
    }
    return best;
}

std::optional<SurfaceHit> largestTriangle(const TriangleSource& triangles, const glm::dvec3& front) {
    std::optional<SurfaceHit> largest;
    double most = 0.0;
    triangles([&](const SurfaceTriangle& triangle) {
        const glm::dvec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
        const glm::dvec3 cross = glm::cross(b - a, c - a);
        const double area = glm::length(cross);
        if (!(area > most))
            return;
        most = area;
        largest = SurfaceHit{(a + b + c) / 3.0, cross / (glm::dot(cross, front) < 0.0 ? -area : area),
                             triangle.object};
    });
    return largest;
}

} // namespace

std::optional<SurfaceHit> hitAt(const TriangleSource& triangles, const StrokePlace& place) {
    const double length = glm::length(place.normal);
    if (!(length > 0.0) || !std::isfinite(length))
        return std::nullopt;
    Bounds point;
    point.include(place.point);
    const ProbeView view = viewOf(point, place.normal / length);
    const std::array<glm::dvec2, 1> middle{glm::dvec2(0.0)};
    const std::optional<SurfaceHit> hit = probe(triangles, view, middle, kNear)[0];
    return hit && view.viewed(hit->point).z >= -kNear ? hit : std::nullopt;
}

std::vector<StrokeSite> sitesOf(const TriangleSource& triangles, const Bounds& bounds,
                                const StrokeRequest& request) {
    if (request.place)
        if (const auto hit = hitAt(triangles, *request.place))
            return {siteAt(triangles, bounds, *hit)};
    const double length = glm::length(request.front);
    const glm::dvec3 towards =
        length > 0.0 && std::isfinite(length) ? request.front / length : glm::dvec3(0.0, 0.0, 1.0);
    const std::array<glm::dvec3, 7> fronts{towards,    {0, 1, 0},  {0, 0, 1}, {1, 0, 0},
                                           {-1, 0, 0}, {0, 0, -1}, {0, -1, 0}};
    std::vector<StrokeSite> sites;
    for (const glm::dvec3& front : fronts) {
        for (const SurfaceHit& hit : hitsFacing(triangles, bounds, front))
            sites.push_back(siteAt(triangles, bounds, hit));
        if (!sites.empty())
            return sites;
    }
    if (const auto hit = largestTriangle(triangles, towards))
        return {siteAt(triangles, bounds, *hit)};
    throw Error("simulated hand", "", "the model has no surface that could be touched",
                "open a model with triangles that are not all of zero area");
}

} // namespace touchstone
