// Moves where shapes hold the proxy: leaps to where it rests, ramps over kinks, slides up a surface that
// rises.

#include "haptics/contact/near_contacts.h"
#include "haptics/contact/sweep.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/proxy/rising_slide.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

/// Slopes of the ramps over kinks between a shape's cells: on a torus of 25 mm, cells of 0.5 mm meet at
/// 0.02 rad.
constexpr double kLowRamp = 1.0 / 16.0, kHighRamp = 0.25;
/// Lifts (rising_slide.h) that count as a move. With their sweeps they cost more, so that a tick of lifts
/// alone takes three times as long as one of moves; with fewer, a groove's steps use up the budget.
constexpr int kLiftsPerMove = 3;

} // namespace

/// To a place on the surface that holds the proxy with this normal: along the chord where the surface rises,
/// along the tangent plane and then down where it falls. Kinks between cells may stand above either; then
/// over them, on a ramp. Made whole or not at all.
bool ProxySolver::goOver(const glm::dvec3& place, const glm::dvec3& normal) noexcept {
    const glm::dvec3 start = state_.proxy, way = place - start;
    const double length = glm::length(way), fall = std::max(-glm::dot(way, normal), 0.0);
    for (const double height :
         {fall, std::max(2.0 * fall, kLowRamp * length), std::max(4.0 * fall, kHighRamp * length)}) {
        if (height > 0.0 && !goStraight(place + height * normal))
            continue;
        if (goStraight(place))
            return true;
        if (height > 0.0) { // what stops the way down stops it from higher up, too
            placeAt(start);
            return false;
        }
    }
    return false;
}

/// From where one shape alone holds the proxy to where it rests on that shape, which the shape knows: a
/// tangent plane finds it only in the limit, in some eight moves on a curved field. Made whole or not at all,
/// and only towards the goal; the next move sees whether the proxy rests there.
[[gnu::noinline]] bool ProxySolver::leapToRest(const glm::dvec3& goal) noexcept {
    --leaps_;
    const std::span<const Contact> contacts(rest_.contacts.data(), rest_.contactCount);
    const int object = contacts[0].object;
    if (std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
            return contact.candidate != Contact::kNoCandidate || contact.object != object;
        }))
        return false;
    const glm::dvec3 start = state_.proxy;
    glm::dvec3 place;
    if (!state_.candidates.shapes().restNear(object, start, goal, radius_ + kContactGap, place))
        return false;
    const glm::dvec3 way = place - start;
    const double length = glm::length(way);
    // It ends about where the tangent planes lead, off by the depth times the curvature. What is farther off
    // than their move is long lies beyond an edge, where no slide ends. (Failed: from the face of a cut ball,
    // 1 mm deep, over its rim.)
    const glm::dvec3& planar = rest_.activeSet.point;
    const glm::dvec3 off = way - planar;
    if (!(length > 0.0) || glm::dot(off, off) > glm::dot(planar, planar) ||
        !(glm::dot(way, goal - start) > 0.5 * length * length) || cover(way / length, length) < length)
        return false;
    const Contact& falls = *std::min_element(contacts.begin(), contacts.end(), [&](auto& a, auto& b) {
        return glm::dot(way, a.normal) < glm::dot(way, b.normal);
    });
    if (!goOver(place, falls.normal))
        return false;
    lastMove_ = length;
    return true;
}

/// A slide that a shape, or something beside it, has stopped after `share`. Out of line: meshes alone need
/// none of it.
[[gnu::noinline]] void ProxySolver::slideUp(const glm::dvec3& goal, const glm::dvec3& move, double share,
                                            double covered) noexcept {
    const StoppedSlide slide{
        .start = state_.proxy,
        .goal = goal,
        .planes = {rest_.planes.data(), rest_.contactCount},
        .move = move,
        .share = share,
        .covered = covered,
        .radius = radius_,
        .strikeGap = kStrikeGap,
        .lifts = std::clamp(budget_ - static_cast<int>(rest_.iterations), 1, static_cast<int>(kMostLifts))};
    const SlideUp up = alongRisingSurface(state_.candidates, slide, slide_);
    state_.proxy += up.displacement;
    lastMove_ = glm::length(up.displacement);
    rest_.iterations += static_cast<uint32_t>(up.lifts / kLiftsPerMove);
}

/// In a hollow that is sharper than the goal is deep under it each slide overshoots the bottom, up to where
/// the surface has risen by the contact gap: the proxy would circle there until the budget ends. True where a
/// slide on a shape is no shorter than the one before, and gains no more than a gap does.
[[gnu::noinline]] bool ProxySolver::circles(const glm::dvec3& goal, double length) noexcept {
    if (rest_.activeSet.count == 0 || state_.candidates.shapes().empty())
        return false;
    const double before = std::exchange(lastSlide_, length);
    if (length < before || length * length > 2.0 * kContactGap * glm::length(goal - state_.proxy))
        return false;
    const std::span<const int> active(rest_.activeSet.active.data(),
                                      static_cast<size_t>(rest_.activeSet.count));
    return std::any_of(active.begin(), active.end(), [&](int i) {
        return rest_.contacts[static_cast<size_t>(i)].candidate == Contact::kNoCandidate;
    });
}

} // namespace touchstone
