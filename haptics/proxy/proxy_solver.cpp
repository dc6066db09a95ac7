#include "haptics/proxy/proxy_solver.h"

#include "haptics/contact/near_contacts.h"
#include "haptics/contact/sweep.h"
#include "haptics/proxy/moving_obstacles.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace touchstone {

namespace {

/// Moves without progress after which the proxy counts as resting.
constexpr int kFruitlessMoves = 2;

/// Moves of a drop that may exceed the budget: one, and those that small candidate balls add.
constexpr int kDropMoves = 4;

/// Moves after which the proxy may be creeping around an edge.
constexpr uint32_t kCreeping = 5;

/// A slide ends over the next facet, or over the rounded edge, where it leads past a convex edge. What is
/// then nearer than this share of the slide, up to 6 degrees between the facets, counts as if it were
/// touched: its plane lets the proxy down and along in one move, in place of a drop and a slide. (A quarter
/// of the slide is slower: more triangles are near.)
constexpr double kNearBelow = 0.1;

/// Moves after which the proxy may be circling at the bottom of a shape's hollow.
constexpr uint32_t kCircling = 10;
/// Leaps that a solve tries. One is mostly enough; a second one where the first met another cell's kink.
constexpr int kLeaps = 2;

} // namespace

ProxySolver::ProxySolver(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                         DeviceState& state, SolveResult& rest) noexcept
    : scene_(scene), motions_(motions), workspaceRadius_(settings.proxyRadius),
      budget_(settings.iterationBudget), state_(state), rest_(rest) {
    rest_.contactCount = 0;
    rest_.iterations = 0;
    rest_.flags = 0;
    rest_.activeSet = SubGoal{};
    state_.candidates.moved(); // another contact model may have moved the proxy
    state_.candidates.fetchOn();
    adoptReference(state_.reference);
}

void ProxySolver::followObjects(const HapticScene& scene, ObjectMotions motions,
                                const HapticSettings& settings, DeviceState& state,
                                uint32_t& flags) noexcept {
    sweepMovingObstacles(scene, motions, settings.proxyRadius, state, flags);
}

bool ProxySolver::begin() noexcept {
    if (state_.placed)
        return true;
    placeAt(motions_[static_cast<size_t>(state_.reference)].workspaceFromObject.inversePoint(state_.hip));
    if (!mayBegin(scene_, motions_, state_))
        return false;
    state_.candidates.invalidate(); // an object that moved since is not where it was gathered
    state_.placed = isFree();
    return state_.placed;
}

void ProxySolver::adoptReference(int reference) noexcept {
    state_.reference = reference;
    const auto index = static_cast<size_t>(reference);
    const double skin = 0.5 * kWeldTolerance * scene_.objects[index]->diagonal;
    const double scaled = workspaceRadius_ / motions_[index].workspaceFromObject.scale;
    radius_ = std::max(scaled, skin);
    const glm::dvec3 travel = motions_[index].workspaceFromObject.inverse().direction(state_.travel);
    const double workspaceTravel = glm::length(travel);
    travel_ = workspaceTravel / motions_[index].workspaceFromObject.scale;
    heading_ = workspaceTravel > 0.0 ? travel / workspaceTravel : glm::dvec3(0.0);
    if (motions_.data() != scene_.restMotions.data() && motions_[index].moves()) [[unlikely]]
        headWithReference(motions_[index]);
    // A surface that gives way under a hand at rest takes the proxy along: it must not creep after it
    // (cover).
    if (const MeshInstant* instant = scene_.objects[index]->instant; instant != nullptr) [[unlikely]]
        travel_ += instant->travel;
    if (scene_.plan.oneSided)
        state_.candidates.standsClearBy(
            state_.placed ? state_.clearance / motions_[index].workspaceFromObject.scale : INFINITY);
}

/// The way of the hand in the frame of an object that moves: the hand may rest, and the object pass by. Out
/// of line: code that few ticks need must not take registers from code that all do.
[[gnu::noinline]] void ProxySolver::headWithReference(const ObjectMotion& reference) noexcept {
    const glm::dvec3 way = reference.workspaceFromObject.inversePoint(state_.hip) -
                           reference.before.inversePoint(state_.hip - state_.travel);
    constexpr double kRounding = 1e-13; // where the hand moves as the object does
    travel_ = glm::length(way);
    heading_ = travel_ > kRounding ? way / travel_ : glm::dvec3(0.0);
}

/// A radius that grew takes effect once the proxy is clear by it wherever it may return to. Until then a
/// nearer surface lifts the proxy and does not count as one that it is coming through.
void ProxySolver::measureClearance() noexcept {
    CandidateCache& cache = state_.candidates;
    double stands = cache.standing();
    if (stands < radius_ && cover(glm::dvec3(0.0), 0.0) >= 0.0) {
        const double reach = radius_ + kContactReach;
        double least = cache.clearanceAt(state_.proxy, radius_);
        if (state_.friction != FrictionState::Free)
            least = cache.freeAlong(state_.frictionless, heading_, reach) >= 0.0
                        ? std::min(least, cache.clearanceAt(state_.frictionless, radius_))
                        : stands;
        stands = least > radius_ - CandidateCache::kNotClear ? radius_ : least;
    }
    state_.clearance =
        std::min(stands, radius_) * motions_[static_cast<size_t>(state_.reference)].workspaceFromObject.scale;
}

/// False where there are more than fit.
bool ProxySolver::findAllContacts(double within) noexcept {
    bool full = false;
    rest_.contactCount =
        touchstone::findContacts(state_.candidates, state_.proxy, radius_, within, rest_.contacts, full);
    return !full;
}

/// Where the proxy would move to among the planes of the contacts.
[[gnu::always_inline]] inline void ProxySolver::findSubGoal(const glm::dvec3& goal) noexcept {
    for (uint32_t i = 0; i < rest_.contactCount; ++i)
        rest_.planes[i] = {rest_.contacts[i].normal, planeOffset(rest_.contacts[i].gap)};
    rest_.activeSet = nearestFeasible(goal - state_.proxy, {rest_.planes.data(), rest_.contactCount});
}

/// The same where `all` contacts are known, or only as many as fit.
[[gnu::always_inline]] inline void ProxySolver::findSubGoal(const glm::dvec3& goal, bool all) noexcept {
    if (all) [[likely]]
        findSubGoal(goal);
    else
        findSubGoalAmongMany(goal);
}

/// More contacts than fit, as at a vertex of a thousand facets, each seen from beside its edges. At most
/// three hold the proxy: the plane that the sub-goal breaks most takes the place of one that does not. Each
/// exchange takes the sub-goal farther from the goal, so that none comes back.
[[gnu::noinline]] void ProxySolver::findSubGoalAmongMany(const glm::dvec3& goal) noexcept {
    constexpr int kExchanges = 64; // of a tick: each looks through all that is near
    const double tolerance = 2.0 * detail::kPlaneTolerance * (1.0 + glm::length(goal - state_.proxy));
    const SubGoal& found = rest_.activeSet;
    const auto holds = [&found](uint32_t contact) {
        const auto end = found.active.begin() + found.count;
        return std::find(found.active.begin(), end, static_cast<int>(contact)) != end;
    };
    uint32_t next = 0;
    bool all = true;
    while (true) {
        findSubGoal(goal);
        const std::optional<Contact> broken =
            mostBroken(state_.candidates, state_.proxy, radius_, kContactReach, found.point, tolerance, all);
        if (found.exact && all && !broken)
            return;
        if (!found.exact || !broken || ++exchanges_ > kExchanges)
            break;
        if (rest_.contactCount < SolveResult::kMaxContacts) {
            rest_.contacts[rest_.contactCount++] = *broken;
            continue;
        }
        while (holds(next)) // three of them at most
            next = (next + 1) % SolveResult::kMaxContacts;
        rest_.contacts[next] = *broken;
        next = (next + 1) % SolveResult::kMaxContacts;
    }
    rest_.flags = rest_.flags | TickFlag::CandidatesFull;
}

/// Over a convex edge: the same with what is near, of what the ball holds, and not touched. Where that is too
/// much, or would hold the proxy, it counts for nothing, and the proxy drops. Out of line: code that few
/// ticks need must not take registers from code that all do.
[[gnu::noinline]] void ProxySolver::findSubGoalBelow(const glm::dvec3& goal) noexcept {
    if (findAllContacts(kNearBelow * slid_)) {
        findSubGoal(goal);
        if (glm::length(rest_.activeSet.point) > restLength(rest_.iterations))
            return;
    }
    rest_.contactCount = 0;
    findSubGoal(goal);
}

/// Ends a solve, over an edge without what was found near and not touched: no contact of the tick.
bool ProxySolver::stop(bool overEdge) noexcept {
    if (overEdge) {
        rest_.contactCount = 0;
        rest_.activeSet = SubGoal{};
    }
    return false;
}

void ProxySolver::placeAt(const glm::dvec3& p) noexcept {
    state_.candidates.moved();
    state_.proxy = p;
}

bool ProxySolver::isFree() noexcept {
    const double reach = radius_ + kContactGap;
    return cover(glm::dvec3(0.0), 0.0) >= 0.0 &&
           nearestDistance(state_.candidates, state_.proxy, reach, radius_) >= reach;
}

bool ProxySolver::returnTo(const glm::dvec3& p, const glm::dvec3&) noexcept {
    placeAt(p);
    moveTowards(p);
    return touches(rest_);
}

void ProxySolver::moveTowards(const glm::dvec3& goal) noexcept {
    leaps_ = kLeaps;
    slid_ = 0.0;
    while (advance(goal)) {
    }
    leaps_ = 0; // a drop does not slide
}

void ProxySolver::dropTowards(const glm::dvec3& goal) noexcept {
    const int budget =
        std::exchange(budget_, std::max(budget_, static_cast<int>(rest_.iterations) + kDropMoves));
    bool landed = false, all = true;
    slid_ = 0.0;
    while (!landed && advance(goal)) {
        all = findAllContacts(kContactReach);
        landed = rest_.contactCount > 0;
    }
    budget_ = budget;
    if (!landed)
        return;
    findSubGoal(goal, all);
}

bool ProxySolver::touchesAt(const glm::dvec3& p) noexcept {
    // Margin for rounding, where other objects move the proxy.
    constexpr double kRounding = 1e-9;
    CandidateCache& cache = state_.candidates;
    const double reach = radius_ + kContactReach, least = radius_ - kRounding;
    // In most cases a facet that the proxy touches now also holds it there.
    for (uint32_t i = 0; i < rest_.contactCount; ++i) {
        const double distance = distanceOf(cache, rest_.contacts[i], p);
        if (std::isinf(distance))
            break;
        if (distance <= reach)
            return distance >= least;
    }
    const auto holds = [&](CandidateCache& covering) {
        const double nearest = nearestDistance(covering, p, reach, radius_);
        return nearest >= least && nearest <= reach;
    };
    if (cache.freeAlong(p, glm::dvec3(0.0), reach) >= 0.0)
        return holds(cache);
    // Too far from the proxy for its ball: gather a small one about p.
    CandidateCache& about = state_.obstacleCandidates;
    about.standsClearBy(cache.standing());
    return gather(about, p, reach) && holds(about);
}

bool ProxySolver::slideOnFacet(const glm::dvec3& goal) noexcept {
    if (rest_.contactCount != 1)
        return false;
    Contact& contact = rest_.contacts[0];
    const glm::dvec3 target = goal - state_.proxy;
    const double above = glm::dot(target, contact.normal);
    // A goal in the air would need a drop.
    if (above > kContactReach)
        return false;
    const glm::dvec3 move = target - above * contact.normal;
    const double length = glm::length(move);
    if (!(length > 0.0))
        return false;
    CandidateCache& cache = state_.candidates;
    if (cache.freeAlong(state_.proxy, move / length, radius_ + kContactReach) < length ||
        timeOfImpact(cache, state_.proxy, move, radius_ + kStrikeGap, 1.0) < 1.0)
        return false;
    if (!moveOnFacet(cache, state_.proxy + move, radius_, contact))
        return false;
    state_.proxy += move;
    cache.moved();
    ++rest_.iterations;
    return true;
}

/// Moves the proxy straight to a place if the whole path is free; else not at all.
bool ProxySolver::goStraight(const glm::dvec3& to) noexcept {
    const glm::dvec3 move = to - state_.proxy;
    const double length = glm::length(move);
    CandidateCache& cache = state_.candidates;
    if (!(length > 0.0) || cache.freeAlong(state_.proxy, move / length, radius_ + kContactReach) < length ||
        timeOfImpact(cache, state_.proxy, move, radius_ + kStrikeGap, 1.0) < 1.0)
        return false;
    placeAt(to);
    return true;
}

/// Around the edge or corner that alone holds the proxy: both legs of rollOver are one move, made whole or
/// not at all.
bool ProxySolver::rollAround(const glm::dvec3& goal) noexcept {
    if (rest_.activeSet.count != 1)
        return false;
    const glm::dvec3 start = state_.proxy;
    const std::optional<RollOver> way =
        rollOver(state_.candidates, rest_.contacts[static_cast<size_t>(rest_.activeSet.active[0])], start,
                 goal, radius_ + kContactGap);
    if (!way || !goStraight(way->corner))
        return false;
    if (goStraight(way->end))
        return true;
    placeAt(start);
    return false;
}

/// One move. False when the proxy rests, or may not or cannot move on; contacts and active set are then up to
/// date.
bool ProxySolver::advance(const glm::dvec3& goal) noexcept {
    if (cover(glm::dvec3(0.0), 0.0) < 0.0)
        return false;
    const bool all = findAllContacts(kContactReach);
    const bool overEdge = rest_.contactCount == 0 && slid_ > 0.0 && rest_.iterations < kCreeping &&
                          state_.candidates.shapes().empty();
    if (overEdge) [[unlikely]]
        findSubGoalBelow(goal);
    else
        findSubGoal(goal, all);
    const glm::dvec3 move = rest_.activeSet.point;
    const double length = glm::length(move);
    if (length <= restLength(rest_.iterations) || withoutProgress_ > kFruitlessMoves ||
        (rest_.iterations >= kCircling && circles(goal, length))) {
        withoutProgress_ = 0;
        return stop(overEdge);
    }
    if (rest_.iterations >= static_cast<uint32_t>(budget_)) {
        rest_.flags = rest_.flags | TickFlag::BudgetReached;
        stop(overEdge);
        // In the air over the surface that it was sliding on: that surface still holds the HIP off, or the
        // force would drop out.
        if (rest_.contactCount == 0 && !findAllContacts(lastMove_))
            rest_.flags = rest_.flags | TickFlag::CandidatesFull;
        return false;
    }
    if (rest_.iterations >= kCreeping && rollAround(goal)) {
        ++rest_.iterations;
        withoutProgress_ = 0;
        slid_ = 0.0;
        return true;
    }
    if (leaps_ > 0 && rest_.contactCount > 0 && rest_.contacts[0].candidate == Contact::kNoCandidate &&
        leapToRest(goal)) {
        ++rest_.iterations;
        withoutProgress_ = 0;
        slid_ = 0.0;
        return true;
    }
    const glm::dvec3 direction = move / length;
    const double known = cover(direction, length);
    if (known < 0.0)
        return stop(overEdge);
    const double limit = std::min(1.0, known / length);
    const double share = timeOfImpact(state_.candidates, state_.proxy, move, radius_ + kStrikeGap, limit);
    lastMove_ = share * length;
    if (share < limit && !state_.candidates.shapes().empty() && rest_.activeSet.count > 0)
        slideUp(goal, move, share, known);
    else
        state_.proxy += share * move;
    slid_ = share >= limit && rest_.activeSet.count > 0 ? lastMove_ : 0.0;
    state_.candidates.moved();
    ++rest_.iterations;
    withoutProgress_ = lastMove_ <= kRestLength ? withoutProgress_ + 1 : 0;
    return true;
}

void changeReference(DeviceState& state, ObjectMotions motions, int reference) noexcept {
    if (reference == state.reference)
        return;
    const Similarity newFromOld = motions[static_cast<size_t>(reference)].workspaceFromObject.inverseTimes(
        motions[static_cast<size_t>(state.reference)].workspaceFromObject);
    state.reference = reference;
    state.proxy = newFromOld.point(state.proxy);
    state.stictionPoint = newFromOld.point(state.stictionPoint);
    state.frictionless = newFromOld.point(state.frictionless);
    state.shadedNormal = newFromOld.direction(state.shadedNormal);
    state.shadedTurn = newFromOld.direction(state.shadedTurn);
    state.candidates.invalidate();
}

} // namespace touchstone
