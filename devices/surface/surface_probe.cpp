#include "devices/surface/surface_probe.h"

#include "engine/math/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace touchstone {

namespace {

/// The probed points in the cells of a square grid, so that a triangle tests only those near it.
class PointGrid {
  public:
    explicit PointGrid(std::span<const glm::dvec2> points) {
        low_ = glm::dvec2(std::numeric_limits<double>::max());
        glm::dvec2 high = -low_;
        for (const glm::dvec2& p : points) {
            low_ = glm::min(low_, p);
            high = glm::max(high, p);
        }
        perMetre_ = static_cast<double>(kSide) / glm::max(high - low_, glm::dvec2(1e-12));
        start_.assign(kSide * kSide + 1, 0);
        for (const glm::dvec2& p : points)
            ++start_[cell(p) + 1];
        for (size_t i = 0; i < kSide * kSide; ++i)
            start_[i + 1] += start_[i];
        members_.resize(points.size());
        std::vector<uint32_t> next(start_.begin(), start_.end() - 1);
        for (uint32_t i = 0; i < points.size(); ++i)
            members_[next[cell(points[i])]++] = i;
    }

    template <class Visit>
    void near(const glm::dvec2& low, const glm::dvec2& high, Visit visit) const {
        if (high.x < low_.x || high.y < low_.y)
            return;
        const glm::uvec2 first = coordinates(low), last = coordinates(high);
        for (uint32_t y = first.y; y <= last.y; ++y)
            for (uint32_t i = start_[y * kSide + first.x]; i < start_[y * kSide + last.x + 1]; ++i)
                visit(members_[i]);
    }

  private:
    static constexpr uint32_t kSide = 128;

    [[nodiscard]] glm::uvec2 coordinates(const glm::dvec2& p) const {
        return glm::uvec2(glm::clamp((p - low_) * perMetre_, glm::dvec2(0.0), glm::dvec2(kSide - 1)));
    }
    [[nodiscard]] size_t cell(const glm::dvec2& p) const {
        const glm::uvec2 at = coordinates(p);
        return size_t{at.y} * kSide + at.x;
    }

    glm::dvec2 low_, perMetre_;
    std::vector<uint32_t> start_, members_;
};

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Not inlined, so that equal corners give equal bits: inlined twice, a compiler may contract the products
/// differently.
[[gnu::noinline]] glm::dvec3 viewedFrom(const ProbeView& view, const glm::dvec3& p) {
    return view.viewed(p);
}

/// A triangle projected into a view.
struct ViewedTriangle {
    glm::dvec3 a, b, c;
    glm::dvec2 a2, b2, c2;
    double area; ///< twice the area, in the plane of the view; its sign is exact

    ViewedTriangle(const ProbeView& view, const SurfaceTriangle& t)
        : a(viewedFrom(view, t.a)), b(viewedFrom(view, t.b)), c(viewedFrom(view, t.c)), a2(a), b2(b), c2(c),
          area(orientation(a2, b2, c2)) {}

    /// Whether `p` is on it, borders included. Barycentric weights cannot decide: those of two triangles that
    /// share an edge are rounded differently, and both may reject a point on it. (1 - wa - wb as the third
    /// weight is off by the rounding of the other two, and lost the diagonal of every square face.)
    [[nodiscard]] bool covers(const glm::dvec2& p) const {
        const double sign = area > 0.0 ? 1.0 : -1.0;
        return sign * orientation(p, a2, b2) >= 0.0 && sign * orientation(p, b2, c2) >= 0.0 &&
               sign * orientation(p, c2, a2) >= 0.0;
    }
    [[nodiscard]] double heightAt(const glm::dvec2& p) const {
        const double flat = cross(b2 - a2, c2 - a2);
        const double wa = cross(b2 - p, c2 - p) / flat, wb = cross(c2 - p, a2 - p) / flat;
        const double height = wa * a.z + wb * b.z + (1.0 - wa - wb) * c.z;
        const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
        // An area below its rounding is that of a wall: its top.
        return std::isfinite(height) ? std::clamp(height, lowest, highest) : highest;
    }
};

/// Distance from `p` to a triangle: to its plane over the interior, else to the nearest edge.
double distanceToTriangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& corners,
                          const glm::dvec3& normal) {
    bool inside = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &from = corners[i], along = corners[(i + 1) % 3] - from;
        inside = inside && glm::dot(glm::cross(along, p - from), normal) >= 0.0;
        const double t = glm::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0, 1.0);
        nearest = std::min(nearest, glm::distance(p, from + t * along));
    }
    return inside ? std::abs(glm::dot(p - corners[0], normal)) : nearest;
}

/// Maximum cosine between the normals of a surface and of a wall beside it: 75 degrees. A proxy pressed in by
/// d climbs a less steep face after some 4 d; a true wall it never climbs.
constexpr double kWallCosine = 0.26;
/// Of the reach: how far a wall must rise above the plane of the surface. Lower ones are facets of a smooth
/// surface.
constexpr double kMinRise = 0.01;
/// Of the reach: height above a hit that is assumed free.
constexpr double kFree = 0.25;

} // namespace

ProbeView viewOf(const Bounds& bounds, const glm::dvec3& towardsViewer) {
    ProbeView view;
    view.centre = bounds.centre();
    view.towards = towardsViewer;
    const glm::dvec3 upright = std::abs(towardsViewer.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    view.right = glm::normalize(glm::cross(upright, view.towards));
    view.up = glm::cross(view.towards, view.right);
    const glm::dvec3 half = 0.5 * bounds.extent();
    view.half = {glm::dot(glm::abs(view.right), half), glm::dot(glm::abs(view.up), half),
                 glm::dot(glm::abs(view.towards), half)};
    return view;
}

std::vector<std::optional<SurfaceHit>> probe(const TriangleSource& triangles, const ProbeView& view,
                                             std::span<const glm::dvec2> points, double ceiling) {
    std::vector<std::optional<SurfaceHit>> hits(points.size());
    if (points.empty())
        return hits;
    const PointGrid grid(points);
    std::vector<double> highest(points.size(), -std::numeric_limits<double>::infinity());

    triangles([&](const SurfaceTriangle& triangle) {
        if (!triangle.feltFrom(view.towards))
            return;
        const ViewedTriangle seen(view, triangle);
        if (seen.area == 0.0)
            return; // edge-on: a point on it is on the border of a neighbour
        const glm::dvec2 low = glm::min(seen.a2, glm::min(seen.b2, seen.c2)),
                         high = glm::max(seen.a2, glm::max(seen.b2, seen.c2));
        grid.near(low, high, [&](uint32_t i) {
            if (!seen.covers(points[i]))
                return;
            const double height = seen.heightAt(points[i]);
            if (height <= highest[i] || height > ceiling)
                return;
            const glm::dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
            const double length = glm::length(normal);
            if (!(length > 0.0))
                return;
            highest[i] = height;
            hits[i] = SurfaceHit{view.point({points[i].x, points[i].y, height}),
                                 normal * ((seen.area > 0.0 ? 1.0 : -1.0) / length), triangle.object};
        });
    });
    return hits;
}

std::vector<double> wallsBeside(const TriangleSource& triangles, const ProbeView& view,
                                std::span<const glm::dvec2> points,
                                std::span<const std::optional<SurfaceHit>> hits, double reach) {
    std::vector<double> highest(points.size(), -std::numeric_limits<double>::infinity());
    if (points.empty())
        return highest;
    const PointGrid grid(points);
    triangles([&](const SurfaceTriangle& triangle) {
        const auto& [a, b, c, object, front] = triangle;
        const glm::dvec3 cross3 = glm::cross(b - a, c - a);
        const double length = glm::length(cross3);
        if (!(length > 0.0))
            return;
        const glm::dvec3 normal = cross3 / length;
        const glm::dvec3 viewedA = view.viewed(a), viewedB = view.viewed(b), viewedC = view.viewed(c);
        const glm::dvec2 a2(viewedA), b2(viewedB), c2(viewedC);
        const double top = std::max({viewedA.z, viewedB.z, viewedC.z});
        grid.near(
            glm::min(a2, glm::min(b2, c2)) - reach, glm::max(a2, glm::max(b2, c2)) + reach, [&](uint32_t i) {
                if (!hits[i] || top <= highest[i])
                    return;
                // Whatever the winding, the outside of the triangle is on the side of the free space above
                // the hit. So the back of a thin plate, seen from the hit, has the orientation of the front
                // and is no wall.
                const glm::dvec3 &surface = hits[i]->normal, free = hits[i]->point + kFree * reach * surface;
                const double facing =
                    glm::dot(normal, surface) * (glm::dot(free - a, normal) < 0.0 ? -1.0 : 1.0);
                if (facing > kWallCosine)
                    return;
                const double rise =
                    std::max({glm::dot(a - hits[i]->point, surface), glm::dot(b - hits[i]->point, surface),
                              glm::dot(c - hits[i]->point, surface)});
                if (rise < kMinRise * reach)
                    return;
                if (distanceToTriangle(hits[i]->point, {a, b, c}, normal) <= reach)
                    highest[i] = top;
            });
    });
    return highest;
}

bool breaksOff(const ProbeView& view, const SurfaceHit& from, const SurfaceHit& to, double tolerance) {
    const glm::dvec3 way = view.viewed(to.point) - view.viewed(from.point);
    const auto predicted = [&](const SurfaceHit& hit) {
        const glm::dvec3 normal = view.viewed(view.centre + hit.normal);
        return -(normal.x * way.x + normal.y * way.y) / std::max(normal.z, 1e-3);
    };
    const auto [low, high] = std::minmax({predicted(from), predicted(to)});
    return way.z < low - tolerance || way.z > high + tolerance;
}

} // namespace touchstone
