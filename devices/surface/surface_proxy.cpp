#include "devices/surface/surface_proxy.h"

#include "engine/math/few_planes.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kMoves = 24;
/// Of the gap: extension of a triangle beyond its edges. It closes the cracks between triangles whose corners
/// differ by rounding, which contact welds. Less than 1: a face extended farther over its convex edge than
/// the proxy's gap to the next face would hold the proxy there, as in a corner.
constexpr double kBeyond = 0.1;

/// Whether `q`, in the plane of the triangle, is on it or within `beyond` m of it.
bool covers(const SurfaceTriangle& t, const glm::dvec3& normal, const glm::dvec3& q, double beyond) {
    const auto inside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec3 along = to - from;
        const double area = glm::dot(glm::cross(along, q - from), normal);
        return area >= 0.0 || area * area <= beyond * beyond * glm::dot(along, along);
    };
    return inside(t.a, t.b) && inside(t.b, t.c) && inside(t.c, t.a);
}

} // namespace

SurfaceProxy::Hit SurfaceProxy::firstAlong(const glm::dvec3& way) const {
    Hit first;
    triangles_->along(place_, place_ + way, [&](const SurfaceTriangle& t) {
        const glm::dvec3 cross = glm::cross(t.b - t.a, t.c - t.a);
        const double length = glm::length(cross);
        if (!(length > 0.0))
            return;
        const glm::dvec3 normal = cross / length;
        const double start = glm::dot(normal, place_ - t.a), rate = glm::dot(normal, way), end = start + rate;
        // Distances below half a gap count as zero: a hand that rests on the surface must not pull the proxy
        // onto it, where the side depends on rounding.
        const double nearest = start > 0.0 ? end : -end;
        if (nearest > 0.5 * gap_ || (start > 0.0 ? rate : -rate) >= 0.0)
            return;
        if (t.front != 0 && (start > 0.0 ? 1 : -1) != t.front)
            return; // approaches a one-sided triangle from behind
        const double fraction = std::clamp(-start / rate, 0.0, 1.0);
        if (fraction >= first.fraction || !covers(t, normal, place_ + fraction * way, kBeyond * gap_))
            return;
        first = {fraction, std::abs(start), start > 0.0 ? normal : -normal};
    });
    return first;
}

void SurfaceProxy::follow(const glm::dvec3& hip) {
    touches_ = false;
    FewPlanes<double> planes;
    FewPlanesGoal<double> goal;
    goal.point = hip - place_;
    for (int move = 0; move < kMoves; ++move) {
        if (goal.point == glm::dvec3(0.0))
            return;
        const Hit hit = firstAlong(goal.point);
        if (hit.fraction > 1.0) {
            place_ += goal.point;
            return;
        }
        touches_ = true;
        // Up to the gap over the triangle, back along the move, which is free.
        const double approach = -glm::dot(hit.normal, goal.point);
        const double share =
            approach > 0.0 ? std::clamp((hit.height - gap_) / approach, 0.0, hit.fraction) : 0.0;
        const glm::dvec3 moved = share * goal.point;
        place_ += moved;
        // Only the planes that still hold it, and the one just met.
        FewPlanes<double> held;
        for (size_t i = 0; i < planes.count; ++i) {
            planes.plane[i].offset -= glm::dot(planes.plane[i].normal, moved);
            const bool active = planes.count < FewPlanes<double>::kMax ||
                                std::find(goal.active.begin(), goal.active.begin() + goal.count, i) !=
                                    goal.active.begin() + goal.count;
            if (active)
                held.plane[held.count++] = planes.plane[i];
        }
        const double height = hit.height - share * approach;
        held.plane[held.count++] = {hit.normal, std::min(0.0, gap_ - height)};
        planes = held;
        goal = nearestOnPlanes(hip - place_, planes);
        if (!goal.found)
            return;
    }
}

} // namespace touchstone
