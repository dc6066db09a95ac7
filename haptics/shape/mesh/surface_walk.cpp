#include "haptics/shape/mesh/surface_walk.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr uint32_t next(uint32_t corner) {
    return corner == 2 ? 0 : corner + 1;
}
constexpr uint32_t previous(uint32_t corner) {
    return corner == 0 ? 2 : corner - 1;
}

const uint32_t* cornersOf(const SurfaceView& surface, TriangleSide side) {
    return &surface.object.indices[3 * static_cast<size_t>(triangleOf(side))];
}

glm::dvec3 vertexAt(const SurfaceView& surface, uint32_t vertex) {
    return glm::dvec3(surface.object.vertices[vertex]);
}

bool isFlatTo(const SurfaceView& surface, TriangleSide side) {
    return surface.normal(side) == glm::dvec3(0.0);
}

/// The side beyond edge `edge` at its point `at`. Triangles without area are skipped: the walk leaves over
/// whichever of their other edges is nearest to the point.
TriangleSide beyond(const SurfaceView& surface, TriangleSide side, uint32_t edge, const glm::dvec3& at) {
    constexpr int kMaxSlivers = 8;
    for (int sliver = 0; sliver < kMaxSlivers; ++sliver) {
        const uint32_t* from = cornersOf(surface, side);
        const uint32_t a = from[edge], b = from[next(edge)];
        const TriangleSide on = surface.adjacency.across(side, edge);
        if (triangleOf(on) == triangleOf(side) || !isFlatTo(surface, on))
            return on;
        const uint32_t* corner = cornersOf(surface, on);
        double nearest = INFINITY;
        for (uint32_t k = 0; k < 3; ++k) {
            if ((corner[k] == a && corner[next(k)] == b) || (corner[k] == b && corner[next(k)] == a))
                continue;
            const glm::dvec3 away = at - detail::closestOnSegment(at, vertexAt(surface, corner[k]),
                                                                  vertexAt(surface, corner[next(k)]));
            if (glm::dot(away, away) < nearest) {
                nearest = glm::dot(away, away);
                edge = k;
            }
        }
        side = on;
    }
    return surface.adjacency.across(side, edge);
}

/// Turns about a vertex on one side of the surface, triangle by triangle.
class Fan {
  public:
    /// `corner` of the triangle is the vertex; `withWinding` selects the edge over which the fan leaves.
    Fan(const SurfaceView& surface, TriangleSide side, uint32_t corner, bool withWinding)
        : surface_(surface), start_(side), side_(side), vertex_(cornersOf(surface, side)[corner]),
          edge_(withWinding ? previous(corner) : corner) {}

    /// False when the fan is at an open border, or complete.
    bool turn() {
        const uint32_t* corner = cornersOf(surface_, side_);
        const uint32_t other = corner[edge_] == vertex_ ? corner[next(edge_)] : corner[edge_];
        const TriangleSide on = surface_.adjacency.across(side_, edge_);
        if (triangleOf(on) == triangleOf(side_)) {
            border_ = true;
            return false;
        }
        // Enter over the edge (vertex, other); leave over the other edge at the vertex.
        const uint32_t* there = cornersOf(surface_, on);
        const uint32_t at = there[0] == vertex_ ? 0 : there[1] == vertex_ ? 1 : 2;
        edge_ = there[next(at)] == other ? previous(at) : at;
        side_ = on;
        corner_ = at;
        return side_ != start_;
    }
    [[nodiscard]] TriangleSide side() const { return side_; }
    [[nodiscard]] uint32_t corner() const { return corner_; }
    [[nodiscard]] bool border() const { return border_; }

  private:
    const SurfaceView& surface_;
    TriangleSide start_, side_;
    uint32_t vertex_, edge_, corner_ = 0;
    bool border_ = false;
};

/// The nearest of the triangles at the vertex of `here`, if one is nearer than that vertex.
SurfacePlace nearestAbout(const SurfaceView& surface, const SurfacePlace& here, const glm::dvec3& goal,
                          WalkBudget& budget) {
    SurfacePlace best = here;
    for (const bool withWinding : {true, false}) {
        Fan fan(surface, here.side, here.index, withWinding);
        while (fan.turn()) {
            if (budget.tests == 0) {
                budget.spent = true;
                return best;
            }
            --budget.tests;
            const SurfacePlace there = nearestOnTriangle(surface, fan.side(), goal);
            if (there.squared < best.squared)
                best = there;
        }
        if (!fan.border())
            break; // all the way round
    }
    return best;
}

/// True where `away`, from a point of edge `edge`, lies in the free sector between this triangle and the
/// next.
bool inFreeSector(const SurfaceView& surface, const SurfacePlace& place, const glm::dvec3& away) {
    const TriangleSide on = beyond(surface, place.side, place.index, place.point);
    if (triangleOf(on) == triangleOf(place.side))
        return true;
    const Triangle here = surface.triangle(place.side), there = surface.triangle(on);
    const glm::dvec3 corners[3] = {here.a, here.b, here.c};
    const glm::dvec3 from = corners[place.index];
    const glm::dvec3 along = glm::normalize(corners[next(place.index)] - from);
    const glm::dvec3 third = corners[previous(place.index)] - from;
    const glm::dvec3 inward = third - glm::dot(third, along) * along;
    const glm::dvec3 up = glm::length(inward) * surface.normal(place.side);
    const glm::dvec3 middle = (there.a + there.b + there.c) / 3.0 - place.point;
    const auto angle = [&](const glm::dvec3& v) {
        constexpr double kTurn = 6.283185307179586;
        const double a = std::atan2(glm::dot(v, up), glm::dot(v, inward));
        return a < 0.0 ? a + kTurn : a;
    };
    return angle(away) < angle(middle - glm::dot(middle, along) * along);
}

bool outsideByNormal(const SurfaceView& surface, const SurfacePlace& place, const glm::dvec3& away,
                     WalkBudget& budget) {
    glm::dvec3 sum(0.0);
    const auto add = [&](TriangleSide side, uint32_t corner) {
        const uint32_t* i = cornersOf(surface, side);
        const glm::dvec3 v = vertexAt(surface, i[corner]);
        const glm::dvec3 e = vertexAt(surface, i[next(corner)]) - v,
                         f = vertexAt(surface, i[previous(corner)]) - v;
        const double angle = std::atan2(glm::length(glm::cross(e, f)), glm::dot(e, f));
        sum += angle * surface.normal(side);
    };
    add(place.side, place.index);
    Fan fan(surface, place.side, place.index, true);
    while (fan.turn()) {
        if (budget.tests == 0) {
            budget.spent = true;
            return false;
        }
        --budget.tests;
        add(fan.side(), fan.corner());
    }
    return fan.border() || glm::dot(away, sum) >= 0.0;
}

} // namespace

Triangle SurfaceView::triangle(TriangleSide side) const {
    const uint32_t* i = cornersOf(*this, side);
    return {vertexAt(*this, i[0]), vertexAt(*this, i[1]), vertexAt(*this, i[2])};
}

glm::dvec3 SurfaceView::normal(TriangleSide side) const {
    const glm::dvec3 n = triangle(side).normal;
    return (side & 1u) == 0 ? n : -n;
}

SurfacePlace nearestOnTriangle(const SurfaceView& surface, TriangleSide side,
                               const glm::dvec3& goal) noexcept {
    const Triangle triangle = surface.triangle(side);
    const glm::dvec3 corners[3] = {triangle.a, triangle.b, triangle.c};
    SurfacePlace place{.side = side, .squared = INFINITY};
    bool within = true;
    for (uint32_t k = 0; k < 3; ++k) {
        const glm::dvec3 &a = corners[k], &b = corners[next(k)];
        const glm::dvec3 along = b - a, offset = goal - a;
        if (glm::dot(glm::cross(along, offset), triangle.normal) > 0.0)
            continue;
        within = false;
        const double length = glm::dot(along, along);
        const double t = length > 0.0 ? glm::dot(offset, along) / length : 0.0;
        const glm::dvec3 point = t <= 0.0 ? a : t >= 1.0 ? b : a + t * along;
        const glm::dvec3 away = goal - point;
        const double squared = glm::dot(away, away);
        if (squared >= place.squared)
            continue;
        place.squared = squared;
        place.point = point;
        place.feature = t > 0.0 && t < 1.0 ? Feature::Edge : Feature::Vertex;
        place.index = t >= 1.0 ? next(k) : k;
    }
    if (within) {
        const double height = glm::dot(goal - triangle.a, triangle.normal);
        place.point = goal - height * triangle.normal;
        place.squared = height * height;
    }
    return place;
}

SurfacePlace walkTowards(const SurfaceView& surface, TriangleSide start, const glm::dvec3& goal,
                         WalkBudget& budget) noexcept {
    SurfacePlace here = nearestOnTriangle(surface, start, goal);
    while (here.feature != Feature::Face) {
        SurfacePlace there = here;
        if (budget.tests == 0) {
            budget.spent = true;
            break;
        }
        --budget.tests;
        if (here.feature == Feature::Edge) {
            const TriangleSide on = beyond(surface, here.side, here.index, here.point);
            if (triangleOf(on) != triangleOf(here.side))
                there = nearestOnTriangle(surface, on, goal);
        } else {
            there = nearestAbout(surface, here, goal, budget);
        }
        if (!(there.squared < here.squared))
            break;
        if (budget.steps == 0) {
            budget.spent = true;
            break;
        }
        --budget.steps;
        here = there;
    }
    return here;
}

bool isOnFreeSide(const SurfaceView& surface, const SurfacePlace& place, const glm::dvec3& point,
                  WalkBudget& budget) noexcept {
    const glm::dvec3 away = point - place.point;
    switch (place.feature) {
    case Feature::Face:
        // A point on the face does not count as free: once it leaves the face, the side that it stood on
        // must be known. 1e-13 object units is above the rounding of a height, and not felt.
        return glm::dot(away, surface.normal(place.side)) > 1e-13;
    case Feature::Edge:
        return inFreeSector(surface, place, away);
    case Feature::Vertex:
        return outsideByNormal(surface, place, away, budget);
    }
    return false;
}

} // namespace touchstone
