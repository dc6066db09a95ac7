#include "haptics/contact/sweep.h"
#include "haptics/proxy/mesh_proxy.h"

#include <cmath>

namespace touchstone {

namespace {

/// A goal nearer to the triangle than this has no direction from it, object units.
constexpr double kNoDirection = 1e-9;
/// Cosine of the farthest roll: the way over the corner is then no longer than 1.16 times the arc.
constexpr double kFarthestRoll = 0.5;
constexpr double kNearestRoll = 1.0 - 1e-9;

} // namespace

/// Moves the proxy straight to a place; if that is not wholly free, not at all.
bool MeshProxy::goStraight(const glm::dvec3& to) noexcept {
    const glm::dvec3 move = to - state_.proxy;
    const double length = glm::length(move);
    CandidateCache& cache = state_.candidates;
    if (!(length > 0.0) || cache.freeAlong(state_.proxy, move / length, radius_ + kContactReach) < length ||
        freeShare(cache, state_.proxy, move, radius_ + 0.5 * kContactGap, 1.0) < 1.0)
        return false;
    placeAt(to);
    return true;
}

/// Around a rounded edge or corner whose axis is a distance e from the goal, slides and drops creep: each
/// turns the proxy by e / radius of the angle that is left. But a rounded triangle is convex, and where the
/// goal leaves it by the shortest way is the rest on it. The way there leads over a place on both tangent
/// planes, which never enter a convex body. That place may be farther from the goal, the end is nearer: both
/// legs are one move, made whole or not at all.
bool MeshProxy::rollAround(const glm::dvec3& goal) noexcept {
    if (rest_.hold.count != 1)
        return false;
    const Contact& holder = rest_.contacts[static_cast<size_t>(rest_.hold.active[0])];
    CandidateCache& cache = state_.candidates;
    size_t held = 0;
    while (held < cache.count() &&
           (cache.item(held).index != holder.triangle || cache.item(held).object != holder.object))
        ++held;
    if (held == cache.count())
        return false;
    const double reach = radius_ + kContactGap;
    const TriangleDistance out = distanceTo(cache.triangle(held), goal);
    const double cosine = glm::dot(out.gradient, holder.normal);
    if (out.distance >= reach || out.distance < kNoDirection || cosine < kFarthestRoll ||
        cosine > kNearestRoll)
        return false;
    const glm::dvec3 start = state_.proxy, end = out.closest + reach * out.gradient;
    if (glm::length(end - goal) >= glm::length(start - goal))
        return false;
    // Along the tangent plane at the start, up to the one at the end.
    const glm::dvec3 along = out.gradient - cosine * holder.normal;
    const glm::dvec3 corner =
        start + glm::dot(end - start, out.gradient) / glm::dot(along, out.gradient) * along;
    if (!goStraight(corner))
        return false;
    if (goStraight(end))
        return true;
    placeAt(start);
    return false;
}

} // namespace touchstone
