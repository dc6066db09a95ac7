// A tick in which objects move, seen from the frame of each object.
//
// Every object D keeps a copy of the proxy in its own frame. When D moves the copy moves with it, so that D
// never meets it. The copies then disagree about the proxy's place in the workspace. The tick is solved when
// they meet again in one place that each of them reached by a path clear of its own object. That is all that
// "never passes through" requires; no order of the objects, no normal and no speed enters into it.
//
// The place is found like a proxy at rest: the point nearest to the proxy's target in the intersection of
// half-spaces. A half-space is the linearised distance from a triangle that stopped a copy, d(c) + grad d(c)
// . (x - c) >= reach, with D at its pose at the end of the step. The distance from a triangle is convex, so
// this never admits a place that is too near; and a copy that moves straight from c, where the inequality
// holds or the move leads away, to such a place cannot meet that triangle on the way. So each round either
// ends with all copies in one place or finds a new triangle. The motion of a surface enters by its pose
// alone: the same inequality describes a surface at rest and one that pushes.
//
// Planes extend beyond the ends of surfaces, and normals turn: where one step of the tick finds no place,
// half a step is tried. Steps are also short enough for an object to turn by little, because a copy moves
// along the chord of what is an arc in its object's frame: with turns of 1/8 rad chord and arc differ by
// 0.0017 of the object's longest side at most. Every chord is still a path clear of the object.
//
// An object whose vertices move (HapticObject::instant) carries its copy nowhere by itself. Its copy stays
// where the step begins, and a place is reached when the straight way there, in the time of the step, is
// clear of all triangles while they move (staysClear). A triangle that is in the way gives its half-space at
// the step's end, linearised where the copy would be had the triangle carried it along: on the side where it
// was.

#include "haptics/contact/near_contacts.h"
#include "haptics/proxy/obstacle_search.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// The largest turn of a step, rad.
constexpr double kLargestTurn = 0.125;
/// The shortest step, in ticks: the resolution at which a jam is detected.
constexpr double kShortestStep = 1.0 / 4096.0;
constexpr int kRounds = 24;
/// Bound of a tick's work. A step without conflict takes one sweep per object.
constexpr int kSweepBudget = 512;

/// The proxy's clearance shrinks with its object.
void shrinkClearance(const ObjectMotion& reference, DeviceState& state) noexcept {
    if (!reference.jumped && reference.workspaceFromObject.scale < reference.before.scale)
        state.clearance *= reference.workspaceFromObject.scale / reference.before.scale;
}

} // namespace

bool MovingObstacles::moves(size_t k) const {
    if (const MeshInstant* instant = scene_.objects[k]->instant; instant != nullptr && instant->travel > 0.0)
        return !motions_[k].jumped;
    return motions_[k].moves();
}

/// True where any part of object k may come within `within` of the proxy's start, by bounding spheres. The
/// origin moves along less than half a circle, which lies in the ball around its chord.
bool MovingObstacles::isNear(size_t k, double within) const {
    const ObjectMotion& motion = motions_[k];
    const Similarity& from = motion.jumped ? motion.workspaceFromObject : motion.before;
    const glm::dvec3 half = 0.5 * (motion.workspaceFromObject.translation - from.translation);
    const glm::dvec3 away = start_ - (from.translation + half);
    const double distance2 = glm::dot(away, away);
    const double reach =
        within + scene_.boundingRadii[k] * std::max(from.scale, motion.workspaceFromObject.scale);
    // Of a thousand objects nearly all are rejected without a square root.
    const double most = std::abs(half.x) + std::abs(half.y) + std::abs(half.z) + reach;
    if (distance2 > most * most)
        return false;
    const double exact = glm::length(half) + reach;
    return distance2 <= exact * exact;
}

/// True where the proxy cannot be at `place` (workspace) for object k at its present pose.
bool MovingObstacles::blockedAt(size_t k, const glm::dvec3& place) noexcept {
    const Similarity& pose = motions_[k].workspaceFromObject;
    const glm::dvec3 p = pose.inversePoint(place);
    if (!scene_.objects[k]->oneSided && insideObject(*scene_.objects[k], p))
        return true;
    CandidateCache& cache = state_.obstacleCandidates;
    cache.standsClearBy(INFINITY);
    const double reach = radius_ / pose.scale + kObstacleGap;
    if (!cache.gather({&scene_.objects[k], 1}, motions_.subspan(k, 1),
                      std::span(scene_.boundingRadii).subspan(k, 1), 0, p, reach))
        return true;
    return nearestDistance(cache, p, reach, reach) < reach;
}

/// False when an object was placed where the proxy is.
bool MovingObstacles::settleJumps() noexcept {
    for (size_t k = 0; k < motions_.size(); ++k) {
        if (!motions_[k].jumped)
            continue;
        flags_ = flags_ | TickFlag::ObjectJumped;
        const int object = static_cast<int>(k);
        if (object == state_.reference)
            state_.friction = FrictionState::Free;
        for (size_t i = 0; i < state_.jammed.count; ++i)
            if (state_.jammed.objects[i] == object)
                state_.jammed.remove(i--);
        if (isNear(k, 2.0 * radius_) && blockedAt(k, start_))
            return false;
    }
    return true;
}

/// Lists all objects that can affect this tick. False when there are too many.
bool MovingObstacles::listNear() noexcept {
    near_ = 0;
    for (size_t k = 0; k < scene_.objects.size(); ++k) {
        const int object = static_cast<int>(k);
        if (!isNear(k, room_) || state_.jammed.holds(object))
            continue;
        if (near_ == state_.carried.size())
            return false;
        MovingObstacle& copy = state_.carried[near_++];
        ObjectMotion motion = motions_[k];
        if (motion.jumped)
            motion.before = motion.workspaceFromObject;
        copy.object = object;
        copy.path = ObjectPath(motion);
        copy.bounding = scene_.objects[k]->boundingRadius;
        deforming_ |= scene_.objects[k]->instant != nullptr && !motion.jumped;
        unit_ = std::min(unit_, motion.workspaceFromObject.scale);
        largestAngle_ = std::max(largestAngle_, copy.path.angle());
    }
    return true;
}

void MovingObstacles::startStep(double from, double to) noexcept {
    from_ = from;
    to_ = to;
    for (MovingObstacle& copy : std::span(state_.carried).first(near_)) {
        const Similarity start = copy.path.at(from);
        copy.place = copy.origin = start.inversePoint(place_);
        copy.standing = (from > 0.0 ? radius_ : std::min(state_.clearance, radius_)) / start.scale;
        copy.pose = copy.path.at(to);
        copy.reach = radius_ / copy.pose.scale + kObstacleGap;
    }
    struckCount_ = 0;
}

/// The place nearest to `target` that satisfies all hit triangles; false where there is none.
///
/// A full list is cut down to the planes that hold the place (three at most). They alone lead to the same
/// place, and each plane that a later round adds takes it farther from the target, so that no set comes
/// twice; what was left out and is in the way again is found again. A vertex of 32 facets, each in the way of
/// a proxy that presses it, was a jam where the list ended instead.
bool MovingObstacles::nearestPlace(std::span<const MovingObstacle> copies, const glm::dvec3& target,
                                   double unit, glm::dvec3& place) noexcept {
    for (size_t i = 0; i < struckCount_; ++i) {
        const MovingObstacle& copy = copies[hit_[i].copy];
        const FeatureDistance d = hit_[i].from(copy.place);
        const glm::dvec3 normal = copy.pose.direction(d.gradient);
        const double lack = copy.pose.scale * (copy.reach - d.distance);
        planes_[i] = {normal, (lack + glm::dot(normal, copy.pose.point(copy.place) - target)) / unit};
    }
    const SubGoal goal = nearestFeasible(glm::dvec3(0.0), {planes_.data(), struckCount_});
    if (!goal.exact)
        return false;
    place = target + unit * goal.point;
    if (goal.count > 0) {
        pusher_ = copies[hit_[index(goal.active[0])].copy].object;
        anchorPushes_ = false;
        for (int i = 0; i < goal.count; ++i)
            anchorPushes_ |=
                copies[hit_[index(goal.active[static_cast<size_t>(i)])].copy].object == state_.reference;
    }
    if (struckCount_ == kMaxHit)
        keepOnly(goal);
    return true;
}

void MovingObstacles::keepOnly(const SubGoal& goal) noexcept {
    std::array<Hit, 3> held;
    struckCount_ = static_cast<size_t>(goal.count);
    for (size_t i = 0; i < struckCount_; ++i)
        held[i] = hit_[index(goal.active[i])];
    std::copy_n(held.begin(), struckCount_, hit_.begin());
}

/// Brings the copies together at the end of a step. False: no such place was found.
bool MovingObstacles::solve(const glm::dvec3& target) noexcept {
    const std::span<MovingObstacle> copies = std::span(state_.carried).first(near_);
    for (int round = 0; round < kRounds && sweeps_ < kSweepBudget; ++round) {
        glm::dvec3 place;
        if (!nearestPlace(copies, target, unit_, place) || glm::length(place - start_) > room_ - radius_)
            return false;
        const size_t known = struckCount_;
        revised_ = false;
        bool together = true;
        for (size_t i = 0; i < near_; ++i)
            together &= sweep(i, copies[i], copies[i].pose.inversePoint(place));
        if (together) {
            place_ = place;
            return true;
        }
        if (struckCount_ == known && !revised_)
            return false;
    }
    return false;
}

/// The proxy's place without obstacles: its present place, or the place to which a surface that it sticks to
/// takes it; no farther than friction can hold it back.
glm::dvec3 MovingObstacles::target(double step) noexcept {
    if (state_.friction == FrictionState::Free)
        return place_;
    for (MovingObstacle& copy : std::span(state_.carried).first(near_))
        if (copy.object == state_.reference) {
            if (instantOf(copy) != nullptr)
                stepDrift_ = (copy.place = carried(copy)) - copy.origin;
            const glm::dvec3 drag = copy.pose.point(copy.place) - place_;
            const double length = glm::length(drag), most = 2.0 * step * glm::length(start_ - state_.hip);
            return length > most ? place_ + most / length * drag : place_ + drag;
        }
    return place_;
}

void MovingObstacles::advance() noexcept {
    const double longest = largestAngle_ > kLargestTurn ? kLargestTurn / largestAngle_ : 1.0;
    double time = 0.0, step = longest;
    while (time < 1.0) {
        const double end = time + step > 1.0 - 0.5 * kShortestStep ? 1.0 : time + step;
        startStep(time, end);
        stepDrift_ = glm::dvec3(0.0);
        if (solve(target(end - time))) {
            time = end;
            drift_ += stepDrift_;
            step = std::min(2.0 * step, longest);
            continue;
        }
        step *= 0.5;
        if (sweeps_ >= kSweepBudget)
            flags_ = flags_ | TickFlag::BudgetReached;
        if (step < kShortestStep || sweeps_ >= kSweepBudget)
            return pinch(time);
    }
}

void MovingObstacles::finish() noexcept {
    const int pusher = anchorPushes_ ? state_.reference : pusher_;
    if (!followJammed()) {
        flags_ = flags_ | TickFlag::Jammed;
        return lose();
    }
    // What the proxy sticks to moves along.
    state_.stictionPoint += drift_;
    state_.frictionless += drift_;
    if (pusher >= 0)
        changeReference(state_, motions_, pusher);
    state_.proxy = motions_[index(state_.reference)].workspaceFromObject.inversePoint(place_);
}

void MovingObstacles::run() noexcept {
    state_.candidates.invalidate();
    if (!settleJumps())
        return lose();
    // Which objects move where the proxy is?
    bool pushed = false, byReferenceOnly = true;
    double way = 0.0, largest = 0.0;
    for (size_t k = 0; k < scene_.objects.size(); ++k) {
        if (!isNear(k, 2.0 * radius_) || !moves(k) || state_.jammed.holds(static_cast<int>(k)))
            continue;
        pushed = true;
        byReferenceOnly &= static_cast<int>(k) == state_.reference;
        way = std::max(way, ObjectPath(motions_[k]).longestWay(scene_.objects[k]->boundingRadius));
        if (const MeshInstant* instant = scene_.objects[k]->instant)
            way += instant->travel * motions_[k].workspaceFromObject.scale;
        largest = std::max(largest, motions_[k].workspaceFromObject.scale);
    }
    if (!pushed)
        return finish();
    // A wedge may push the proxy farther than the wedge itself moves.
    room_ = 2.0 * radius_ + 8.0 * way + 0.25 * largest;
    unit_ = motions_[index(state_.reference)].workspaceFromObject.scale;
    if (!listNear()) {
        flags_ = flags_ | TickFlag::CandidatesFull;
        return lose();
    }
    if (byReferenceOnly && near_ == 1 && state_.jammed.count == 0 && !deforming_)
        return; // the proxy moves with the reference object, as with a single object
    advance();
    if (state_.placed)
        finish();
}

void sweepMovingObstacles(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state,
                          uint32_t& flags) noexcept {
    if (!state.placed || motions.data() == scene.restMotions.data()) {
        if (state.jammed.count > 0) {
            state.jammed.count = 0;
            state.candidates.ignore({});
        }
        return;
    }
    if (scene.plan.oneSided)
        shrinkClearance(motions[static_cast<size_t>(state.reference)], state);
    if (scene.objects.size() < 2 && !motions[0].jumped && scene.objects[0]->instant == nullptr)
        return;
    MovingObstacles(scene, motions, radius, state, flags).run();
    state.candidates.ignore(state.jammed.ignored());
}

} // namespace touchstone
