#include "haptics/finger/polyline.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace touchstone {

namespace {

constexpr double kStraight =
    1e-6; // rad of turn: fractions of the angle and of the edge then differ by its square
constexpr double kSpike = 1e-6;      // rad short of turning back
constexpr double kBesideEdge = 1e-3; // of an edge: a local centre nearer to it would see it edge-on
constexpr double kSamePlace = 1e-12; // of the line's extent
constexpr double kSmallest = 1e-12;  // m
constexpr double kFarthest = 1e6;    // m

glm::dvec2 leftOf(const glm::dvec2& direction) {
    return {-direction.y, direction.x};
}

/// Signed angle from a to a + step, rad: the cross product of a and the step keeps its digits where a is
/// long.
double angleTo(const glm::dvec2& a, const glm::dvec2& step) {
    return std::atan2(crossed(a, step), glm::dot(a, a) + glm::dot(a, step));
}

/// Where the perpendicular bisectors of both edges meet; the midpoint of p1 p3 where that lies on or beyond
/// an edge. The bisectors through p1 and p3 with directions n1 and n2: p1 + x n1 = p3 + y n2.
glm::dvec2 localCentre(const Polyline::Patch& patch, const glm::dvec2& n1, const glm::dvec2& n2) {
    const glm::dvec2 apart = patch.p3 - patch.p1, middle = patch.p1 + 0.5 * apart;
    const double x = crossed(apart, n2) / crossed(n1, n2), y = crossed(apart, n1) / crossed(n1, n2);
    const double inner = glm::dot(middle - patch.p1, n1) < 0.0 ? -1.0 : 1.0; // the side of p1 p3
    const double least1 = 2.0 * kBesideEdge * glm::distance(patch.p1, patch.p2);
    const double least2 = 2.0 * kBesideEdge * glm::distance(patch.p2, patch.p3);
    return inner * x > least1 && inner * y > least2 ? patch.p1 + x * n1 : middle;
}

Polyline::Patch patchAt(const glm::dvec2& before, const glm::dvec2& vertex, const glm::dvec2& after) {
    Polyline::Patch patch{0.5 * (before + vertex), vertex, 0.5 * (vertex + after)};
    const glm::dvec2 d1 = glm::normalize(vertex - before), d2 = glm::normalize(after - vertex);
    patch.straight = std::abs(crossed(d1, d2)) < kStraight && glm::dot(d1, d2) > 0.0;
    if (patch.straight) {
        patch.toVertex = glm::distance(patch.p1, patch.p2);
        patch.fromVertex = glm::distance(patch.p2, patch.p3);
        return patch;
    }
    patch.centre = localCentre(patch, leftOf(d1), leftOf(d2));
    patch.toVertex = angleTo(patch.p1 - patch.centre, patch.p2 - patch.p1);
    patch.fromVertex = angleTo(patch.p2 - patch.centre, patch.p3 - patch.p2);
    return patch;
}

[[noreturn]] void refuse(const std::string& problem, const std::string& remedy) {
    throw Error("polyline", "", problem, remedy);
}

} // namespace

Polyline::Polyline(std::span<const glm::dvec2> points, bool closed) : closed_(closed) {
    glm::dvec2 low(0.0), high(0.0);
    for (size_t i = 0; i < points.size(); ++i) {
        if (!(std::abs(points[i].x) <= kFarthest && std::abs(points[i].y) <= kFarthest))
            refuse("point " + std::to_string(i) + " is not a place within 1000 km",
                   "give coordinates in metres");
        low = i == 0 ? points[i] : glm::min(low, points[i]);
        high = i == 0 ? points[i] : glm::max(high, points[i]);
    }
    const double same = std::max(kSamePlace * glm::distance(low, high), kSmallest);
    for (const glm::dvec2& point : points)
        if (points_.empty() || glm::distance(points_.back(), point) > same)
            points_.push_back(point);
    while (closed && points_.size() > 1 && glm::distance(points_.back(), points_.front()) <= same)
        points_.pop_back();
    if (points_.size() < (closed ? 3u : 2u))
        refuse("it has " + std::to_string(points_.size()) + " places",
               closed ? "a closed line needs three" : "a line needs two");
    const size_t count = points_.size();
    for (size_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
        const glm::dvec2 from = points_[i], to = points_[(i + 1) % count];
        const double length = glm::distance(from, to);
        edges_.push_back({from, to, leftOf((to - from) / length), length});
    }
    for (size_t i = closed ? 0 : 1; i + (closed ? 0 : 1) < count; ++i) {
        const glm::dvec2 before = points_[(i + count - 1) % count], after = points_[(i + 1) % count];
        const glm::dvec2 d1 = glm::normalize(points_[i] - before), d2 = glm::normalize(after - points_[i]);
        if (glm::dot(d1, d2) < 0.0 && std::abs(crossed(d1, d2)) < kSpike)
            refuse("it turns back on itself at point " + std::to_string(i),
                   "give the tip two points: a spike of 180 degrees has no tangent");
        patches_.push_back(patchAt(before, points_[i], after));
    }
}

SurfaceLine Polyline::edge(size_t index) const noexcept {
    return {edges_[index].from, edges_[index].normal};
}

size_t Polyline::patchOf(double u) const noexcept {
    const auto count = static_cast<double>(patches_.size());
    if (!closed_)
        return static_cast<size_t>(std::clamp(std::floor(u), 0.0, count - 1.0));
    const double whole = std::floor(u) - count * std::floor(std::floor(u) / count);
    return std::min(static_cast<size_t>(whole), patches_.size() - 1);
}

SurfaceLine Polyline::tangent(double u) const noexcept {
    if (patches_.empty())
        return edge(0);
    const size_t index = patchOf(u);
    const Patch& patch = patches_[index];
    const double first = closed_ ? std::floor(u) : static_cast<double>(index);
    const double t = std::clamp(u - first, 0.0, 1.0);
    const glm::dvec2 p12 = patch.p1 + t * (patch.p2 - patch.p1), p23 = patch.p2 + t * (patch.p3 - patch.p2);
    return {p12, leftOf(glm::normalize(p23 - p12))};
}

/// With the angles of [004 eqs. 3, 4], t = (lambda_L1 - lambda_P1) / (2 (1 - lambda_P1)) on L1, and there
/// lambda_L1 - lambda_P1 = (theta_contact - theta_P1) / (theta_P2 - theta_P0) and 1 - lambda_P1 = (theta_P2 -
/// theta_P1) / (theta_P2 - theta_P0): P0 cancels. So does P4 in t = 1/2 + lambda_L2 / (2 lambda_P3) on L2.
double Polyline::parameter(const Patch& patch, const glm::dvec2& point) noexcept {
    double past = 0.0; // the vertex
    if (patch.straight)
        past = glm::dot(point - patch.p2, glm::normalize(patch.p3 - patch.p1));
    else
        past = angleTo(patch.p2 - patch.centre, point - patch.p2);
    const double share = past / (past * patch.fromVertex > 0.0 ? patch.fromVertex : patch.toVertex);
    return 0.5 + 0.5 * share;
}

double Polyline::project(double u, const glm::dvec2& point) const noexcept {
    if (patches_.empty())
        return 0.0;
    double first = closed_ ? std::floor(u) : static_cast<double>(patchOf(u));
    const double last = static_cast<double>(patches_.size()) - 1.0;
    int came = 0; // from which side
    for (int i = 0; i < kMostSwitches; ++i) {
        const double t = parameter(patches_[patchOf(first)], point);
        const int side = t < 0.0 ? -1 : t > 1.0 ? 1 : 0;
        if (side == 0)
            return first + t;
        // Where the sectors of neighbours leave a gap, the point belongs to the midpoint between them, where
        // both have the same tangent.
        const bool end = !closed_ && (side < 0 ? first <= 0.0 : first >= last);
        if (end || came * side < 0)
            return side < 0 ? first : std::nextafter(first + 1.0, first);
        came = side;
        first += side;
    }
    return first;
}

bool Polyline::belongsTo(size_t edge, long patch) const noexcept {
    if (patch < 0)
        return false;
    const size_t count = edges_.size(), after = static_cast<size_t>(patch) + (closed_ ? 0 : 1);
    return edge == after % count || edge == (after + count - 1) % count;
}

/// Where the arc's deepest point does not lie over the edge: of its nearer end. An end beside the pad is not
/// touched, however deep.
double Polyline::depthIn(const Edge& edge, const ArcFinger& finger, const FingerPose& pose,
                         const glm::dvec2& centre) noexcept {
    const PadContact contact = finger.touch(pose, {edge.from, edge.normal});
    const double along = glm::dot(contact.point - edge.from, edge.to - edge.from) / edge.length;
    if (along >= 0.0 && along <= edge.length)
        return contact.depth;
    const glm::dvec2 corner = along < 0.0 ? edge.from : edge.to;
    const double location = finger.locationTowards(pose, corner - centre);
    return std::abs(location) >= 0.5 * finger.length ? -glm::distance(corner, finger.skin(pose, location))
                                                     : finger.radius - glm::distance(corner, centre);
}

Polyline::Deepest Polyline::deepest(const ArcFinger& finger, const FingerPose& pose, double than,
                                    long apartFrom) const noexcept {
    Deepest best{.depth = than};
    const glm::dvec2 centre = finger.centre(pose);
    for (size_t i = 0; i < edges_.size(); ++i) {
        const Edge& edge = edges_[i];
        const glm::dvec2 to = centre - edge.from;
        if (glm::dot(to, edge.normal) <= 0.0 || belongsTo(i, apartFrom))
            continue;
        // The whole circle is as deep as any part of it; most edges end here, without an angle.
        const glm::dvec2 run = edge.to - edge.from;
        const double share = std::clamp(glm::dot(to, run) / (edge.length * edge.length), 0.0, 1.0);
        if (finger.radius - glm::length(to - share * run) <= best.depth)
            continue;
        if (const double depth = depthIn(edge, finger, pose, centre); depth > best.depth)
            best = {i, depth, true};
    }
    return best;
}

double Polyline::depthOf(long patch, const ArcFinger& finger, const FingerPose& pose) const noexcept {
    const glm::dvec2 centre = finger.centre(pose);
    const size_t count = edges_.size(), after = static_cast<size_t>(patch) + (closed_ ? 0 : 1);
    double depth = -std::numeric_limits<double>::infinity();
    for (const size_t i : {after % count, (after + count - 1) % count})
        if (glm::dot(centre - edges_[i].from, edges_[i].normal) > 0.0)
            depth = std::max(depth, depthIn(edges_[i], finger, pose, centre));
    return depth;
}

double Polyline::middleOf(size_t edge) const noexcept {
    // Edge i ends at vertex i + 1; on an open line patch i belongs to vertex i + 1, on a closed one to vertex
    // i.
    return static_cast<double>(edge) + (closed_ ? 1.0 : 0.0);
}

} // namespace touchstone
