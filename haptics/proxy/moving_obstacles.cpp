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

#include "haptics/proxy/moving_obstacles.h"

#include "haptics/contact/moving_triangle.h"
#include "haptics/contact/near_contacts.h"
#include "haptics/contact/sweep.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/solve/sub_goal.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// Distance beyond the radius at which the proxy ends a tick, object units: more than the rounding between
/// frames, less than a thousandth of the smallest radius. A sweep ends at half of it.
constexpr double kObstacleGap = 1e-10;
/// A move shorter than this is rounding, object units.
constexpr double kNoMove = 1e-12;
/// The largest turn of a step, rad.
constexpr double kLargestTurn = 0.125;
/// The shortest step, in ticks: the resolution at which a jam is detected.
constexpr double kShortestStep = 1.0 / 4096.0;
constexpr int kRounds = 24;
/// Bound of a tick's work. A step without conflict takes one sweep per object.
constexpr int kSweepBudget = 512;
constexpr int kFollowRounds = 8;
/// Once a jammed object has moved on by this distance (its longest side is 1), touch begins again.
constexpr double kGivenUp = 0.5;
/// Of the distance that the proxy keeps: what a moving triangle leaves it within a step. At the step's end it
/// is the whole distance.
constexpr double kLeftInStep = 0.5;

class MovingObstacles {
  public:
    MovingObstacles(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state,
                    uint32_t& flags) noexcept
        : scene_(scene), motions_(motions), state_(state), flags_(flags) {
        const ObjectMotion& reference = motions_[index(state_.reference)];
        const double skin = 0.5 * kWeldTolerance * scene_.objects[index(state_.reference)]->diagonal;
        radius_ = std::max(radius, skin * reference.before.scale);
        place_ = reference.before.point(state_.proxy);
        start_ = place_;
    }

    void run() noexcept;

  private:
    /// What stopped a copy: a triangle, or a feature of a shape. Object frame.
    struct Hit {
        size_t copy = 0;
        Triangle triangle;
        const Shape* shape = nullptr;
        FeatureId feature = 0;
        bool moving = false; ///< the triangle, at the step's end, of an object that deforms
        glm::dvec3 at{0.0};  ///< then: where it is linearised

        [[nodiscard]] FeatureDistance from(const glm::dvec3& place) const noexcept {
            if (moving) [[unlikely]]
                return fromAside(place);
            if (shape != nullptr)
                return shape->distanceFrom(feature, place);
            const TriangleDistance d = distanceTo(triangle, place);
            return {.distance = d.distance, .gradient = d.gradient, .closest = d.closest};
        }
        /// As if measured at `place`: the plane is what counts.
        [[gnu::noinline]] FeatureDistance fromAside(const glm::dvec3& place) const noexcept {
            const TriangleDistance d = distanceTo(triangle, at);
            return {.distance = d.distance + glm::dot(d.gradient, place - at),
                    .gradient = d.gradient,
                    .closest = d.closest};
        }
    };
    static constexpr size_t kMaxHit = 32;

    static size_t index(int object) { return static_cast<size_t>(object); }
    const HapticObject& objectOf(const MovingObstacle& copy) const {
        return *scene_.objects[index(copy.object)];
    }
    bool moves(size_t k) const;
    [[nodiscard]] const MeshInstant* instantOf(const MovingObstacle& copy) const {
        return objectOf(copy).instant;
    }
    [[nodiscard]] MovingTriangle movingTriangle(const MovingObstacle& copy, uint32_t index) const noexcept;
    bool gatherMoving(const MovingObstacle& copy, const glm::dvec3& to) noexcept;
    bool sweepMoving(size_t copy, MovingObstacle& object, const glm::dvec3& to) noexcept;
    void noteMoving(size_t copy, const MovingObstacle& object, uint32_t index, const MovingTriangle& triangle,
                    const glm::dvec3& to) noexcept;
    [[nodiscard]] glm::dvec3 carried(const MovingObstacle& copy) noexcept;
    bool isNear(size_t k, double within) const;
    bool settleJumps() noexcept;
    bool blockedAt(size_t k, const glm::dvec3& place) noexcept;
    bool listNear() noexcept;
    void startStep(double from, double to) noexcept;
    bool solve(const glm::dvec3& target) noexcept;
    glm::dvec3 target(double step) noexcept;
    void advance() noexcept;
    void pinch(double from) noexcept;
    bool advanceWith(size_t holder, bool commit) noexcept;
    bool followJammed() noexcept;
    bool follow(MovingObstacle& copy) noexcept;
    bool sweep(size_t copy, MovingObstacle& object, const glm::dvec3& to) noexcept;
    void note(size_t copy, const MovingObstacle& object) noexcept;
    bool nearestPlace(std::span<const MovingObstacle> copies, const glm::dvec3& target, double unit,
                      glm::dvec3& place) noexcept;
    void lose() noexcept;
    void finish() noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    DeviceState& state_;
    uint32_t& flags_;
    double radius_; // workspace
    glm::dvec3 start_, place_;
    double room_ = 0.0; // every object within this distance of start_ is known, workspace
    double unit_ = 1.0; // workspace metres per unit of the solve
    double largestAngle_ = 0.0;
    size_t near_ = 0; // copies in use
    int sweeps_ = 0;
    std::array<Hit, kMaxHit> hit_;
    std::array<ConstraintPlane, kMaxHit> planes_;
    size_t struckCount_ = 0;
    bool revised_ = false;                   // a moving triangle was linearised again in this round
    bool deforming_ = false;                 // some object near does
    double from_ = 0.0, to_ = 0.0;           // of the step, in ticks
    glm::dvec3 drift_{0.0}, stepDrift_{0.0}; // of the reference object's deforming surface at the proxy
    int pusher_ = -1;                        // object whose plane held the last place that was pushed
    bool anchorPushes_ = false;
};

bool same(const Similarity& a, const Similarity& b) {
    return a.translation == b.translation && a.rotation == b.rotation && a.scale == b.scale;
}

bool MovingObstacles::moves(size_t k) const {
    if (const MeshInstant* instant = scene_.objects[k]->instant; instant != nullptr && instant->travel > 0.0)
        return !motions_[k].jumped;
    return !motions_[k].jumped && !same(motions_[k].before, motions_[k].workspaceFromObject);
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

/// Stores the feature that stopped the copy.
void MovingObstacles::note(size_t copy, const MovingObstacle& object) noexcept {
    CandidateCache& cache = state_.obstacleCandidates;
    const double touching = object.reach - 0.4 * kObstacleGap;
    cache.eachNear(object.place, touching, [&](size_t i) {
        const double distance = distanceTo(cache.triangle(i), object.place).distance;
        if (struckCount_ < kMaxHit && distance <= touching &&
            !cache.passes(i, object.place, distance, object.reach))
            hit_[struckCount_++] = {copy, cache.triangle(i), nullptr, 0};
    });
    const Shape* shape = scene_.objects[index(object.object)]->shape.get();
    // Each feature of a shape once: it is linearised again in every round.
    (void)cache.shapes().eachNear(object.place, touching, [&](int, const FeatureDistance& d) {
        const auto known = std::span(hit_).first(struckCount_);
        const bool noted = std::any_of(known.begin(), known.end(), [&](const Hit& s) {
            return s.copy == copy && s.shape == shape && s.feature == d.feature;
        });
        if (struckCount_ < kMaxHit && !noted)
            hit_[struckCount_++] = {copy, {}, shape, d.feature};
    });
}

/// Moves a copy straight to `to` (object frame) or as far as its object allows; true when it arrives. A
/// segment with too many triangles is halved; where one remains too dense, the sweep ends.
bool MovingObstacles::sweep(size_t copy, MovingObstacle& object, const glm::dvec3& to) noexcept {
    constexpr int kPieces = 64;
    const glm::dvec3 from = object.place, move = to - from;
    const double length = glm::length(move);
    if (instantOf(object) != nullptr)
        return sweepMoving(copy, object, to);
    if (length <= kNoMove)
        return true;
    const double nearest = std::clamp(-glm::dot(from, move) / (length * length), 0.0, 1.0);
    if (glm::length(from + nearest * move) > object.bounding + object.reach) {
        object.place = to;
        return true;
    }
    ++sweeps_;
    const size_t k = index(object.object);
    CandidateCache& cache = state_.obstacleCandidates;
    cache.standsClearBy(object.standing);
    double done = 0.0, piece = 1.0;
    for (int i = 0; i < kPieces; ++i) {
        const glm::dvec3 start = from + done * move;
        const double ball = 0.5 * piece * length + object.reach + kObstacleGap;
        if (!cache.gather({&scene_.objects[k], 1}, motions_.subspan(k, 1),
                          std::span(scene_.boundingRadii).subspan(k, 1), 0, start + 0.5 * piece * move,
                          ball)) {
            piece *= 0.5;
            continue;
        }
        cache.moved();
        const double first = timeOfImpact(cache, start, move, object.reach - 0.5 * kObstacleGap, piece);
        if (first < piece) {
            object.place = start + first * move;
            note(copy, object);
            return false;
        }
        done += piece;
        object.place = from + done * move;
        if (done >= 1.0) {
            object.place = to;
            return true;
        }
        piece = std::min(2.0 * piece, 1.0 - done);
    }
    flags_ = flags_ | TickFlag::CandidatesFull;
    return false;
}

/// The place nearest to `target` that satisfies all hit triangles; false where there is none.
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
    return true;
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
        if ((struckCount_ == known && !revised_) || struckCount_ == kMaxHit)
            return false;
    }
    return false;
}

/// A triangle's way through the step, object frame.
MovingTriangle MovingObstacles::movingTriangle(const MovingObstacle& copy, uint32_t index) const noexcept {
    const HapticObject& object = objectOf(copy);
    const MeshInstant& instant = *object.instant;
    const uint32_t* corner = &object.indices[3 * static_cast<size_t>(index)];
    const auto at = [&](size_t k, double time) {
        const glm::dvec3 now = instant.now.at(corner[k]);
        if (time >= 1.0)
            return now;
        const glm::dvec3 before = instant.before.at(corner[k]);
        return before + time * (now - before);
    };
    return {Triangle(at(0, from_), at(1, from_), at(2, from_)), Triangle(at(0, to_), at(1, to_), at(2, to_))};
}

/// Lists the triangles that may come near a copy on its way to `to`. From any time of the step to the tick's
/// end, whose places the tree knows, no vertex moves farther than `travel`.
bool MovingObstacles::gatherMoving(const MovingObstacle& copy, const glm::dvec3& to) noexcept {
    const glm::dvec3 half = 0.5 * (to - copy.origin);
    const double ball =
        glm::length(half) + copy.reach + kObstacleGap + (1.0 - from_) * instantOf(copy)->travel;
    CandidateCache& cache = state_.obstacleCandidates;
    const auto k = index(copy.object);
    cache.standsClearBy(INFINITY);
    if (cache.gather({&scene_.objects[k], 1}, motions_.subspan(k, 1),
                     std::span(scene_.boundingRadii).subspan(k, 1), 0, copy.origin + half, ball))
        return true;
    flags_ = flags_ | TickFlag::CandidatesFull;
    return false;
}

/// Moves a copy straight from the step's start to `to` (object frame) while the triangles move; true when
/// nothing is in the way and it ends as far away as it should.
bool MovingObstacles::sweepMoving(size_t copy, MovingObstacle& object, const glm::dvec3& to) noexcept {
    ++sweeps_;
    object.place = object.origin;
    if (!gatherMoving(object, to))
        return false;
    const CandidateCache& cache = state_.obstacleCandidates;
    bool clear = true;
    for (size_t i = 0; i < cache.count(); ++i) {
        const uint32_t index = cache.item(i).index;
        const MovingTriangle triangle = movingTriangle(object, index);
        const double stands = distanceTo(triangle.start, object.origin).distance,
                     ends = distanceTo(triangle.end, to).distance;
        // A proxy that is nearer than its reach (its radius grew) may stay so near.
        const double enough = std::min(object.reach - 0.5 * kObstacleGap, stands);
        if (ends >= enough &&
            staysClear(triangle, object.origin, to, kLeftInStep * std::min(object.reach, stands)))
            continue;
        clear = false;
        noteMoving(copy, object, index, triangle, to);
    }
    if (clear)
        object.place = to;
    return clear;
}

/// Stores the triangle; one that is known is linearised again where its plane led to, if that is free.
void MovingObstacles::noteMoving(size_t copy, const MovingObstacle& object, uint32_t index,
                                 const MovingTriangle& triangle, const glm::dvec3& to) noexcept {
    for (size_t i = 0; i < struckCount_; ++i) {
        Hit& hit = hit_[i];
        if (!hit.moving || hit.copy != copy || hit.feature != index)
            continue;
        const double keep =
            kLeftInStep * std::min(object.reach, distanceTo(triangle.start, object.origin).distance);
        if (hit.at != to && staysClear(triangle, object.origin, to, keep)) {
            hit.at = to;
            revised_ = true;
        }
        return;
    }
    if (struckCount_ < kMaxHit)
        hit_[struckCount_++] = {.copy = copy,
                                .triangle = triangle.end,
                                .shape = nullptr,
                                .feature = index,
                                .moving = true,
                                .at = carriedAlong(triangle, object.origin)};
}

/// Where the surface nearest to a copy takes it through the step, object frame.
glm::dvec3 MovingObstacles::carried(const MovingObstacle& copy) noexcept {
    if (!gatherMoving(copy, copy.origin))
        return copy.origin;
    const CandidateCache& cache = state_.obstacleCandidates;
    double least = INFINITY;
    glm::dvec3 to = copy.origin;
    for (size_t i = 0; i < cache.count(); ++i) {
        const MovingTriangle triangle = movingTriangle(copy, cache.item(i).index);
        const double distance = distanceTo(triangle.start, copy.origin).distance;
        if (distance < least) {
            least = distance;
            to = carriedAlong(triangle, copy.origin);
        }
    }
    return to;
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

/// Moves the proxy to where the holder takes it and sweeps every other copy there as far as its object
/// allows. With `commit` the objects that block it are jammed; else false if there is one.
bool MovingObstacles::advanceWith(size_t holder, bool commit) noexcept {
    const std::span<MovingObstacle> copies = std::span(state_.carried).first(near_);
    const glm::dvec3 target = copies[holder].pose.point(copies[holder].origin);
    for (size_t i = 0; i < near_; ++i) {
        MovingObstacle& copy = copies[i];
        copy.place = copy.origin;
        struckCount_ = 0;
        if (i == holder || sweep(i, copy, copy.pose.inversePoint(target)))
            continue;
        if (!commit)
            return false;
        if (!state_.jammed.add(copy.object, copy.place)) {
            lose();
            return true;
        }
    }
    place_ = target;
    pusher_ = copies[holder].object;
    anchorPushes_ = pusher_ == state_.reference;
    return true;
}

/// No place was found. One of the objects that met may still take the proxy through the rest of the tick, as
/// where a slide between many facets is too long for one tick; else the proxy stays with the one touched
/// last.
void MovingObstacles::pinch(double from) noexcept {
    // No rigid frame to stay with: touch begins again where there is room.
    if (deforming_) {
        flags_ = flags_ | TickFlag::Jammed;
        state_.mustLeave = true;
        return lose();
    }
    std::array<int, 4> touched{-1, -1, -1, -1};
    size_t count = 0, holder = near_;
    for (size_t i = 0; i < near_; ++i)
        if (state_.carried[i].object == state_.reference)
            holder = i;
    if (holder < near_)
        touched[count++] = static_cast<int>(holder);
    for (size_t i = 0; i < struckCount_ && count < touched.size(); ++i) {
        const int copy = static_cast<int>(hit_[i].copy);
        if (std::find(touched.begin(), touched.end(), copy) == touched.end())
            touched[count++] = copy;
    }
    if (count == 0)
        return lose();
    startStep(from, 1.0);
    for (size_t i = 0; i < count; ++i)
        if (advanceWith(index(touched[i]), false))
            return;
    advanceWith(index(touched[0]), true);
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

/// Slides the copy of a jammed object as near to the proxy as that object allows; true when it arrives.
bool MovingObstacles::follow(MovingObstacle& copy) noexcept {
    struckCount_ = 0;
    const std::span<const MovingObstacle> only(&copy, 1);
    for (int round = 0; round < kFollowRounds; ++round) {
        glm::dvec3 place;
        if (!nearestPlace(only, place_, copy.pose.scale, place))
            return false;
        if (sweep(0, copy, copy.pose.inversePoint(place)))
            return glm::length(place - place_) <= 10.0 * kObstacleGap * copy.pose.scale;
    }
    return false;
}

/// Moves the copies of the jammed objects. False when one is so far away that touch must begin again.
bool MovingObstacles::followJammed() noexcept {
    for (size_t i = 0; i < state_.jammed.count; ++i) {
        const size_t k = index(state_.jammed.objects[i]);
        MovingObstacle copy;
        copy.object = state_.jammed.objects[i];
        copy.pose = motions_[k].workspaceFromObject;
        copy.place = state_.jammed.places[i];
        copy.reach = radius_ / copy.pose.scale + kObstacleGap;
        copy.standing =
            std::min(state_.clearance, radius_) / std::max(copy.pose.scale, motions_[k].before.scale);
        copy.bounding = scene_.objects[k]->boundingRadius;
        const bool together = follow(copy);
        state_.jammed.places[i] = copy.place;
        const double apart = glm::length(copy.pose.inversePoint(place_) - copy.place);
        if (together)
            state_.jammed.remove(i--);
        else if (apart > kGivenUp)
            return false;
    }
    if (state_.jammed.count > 0)
        flags_ = flags_ | TickFlag::Jammed;
    return true;
}

void MovingObstacles::lose() noexcept {
    state_.placed = false;
    state_.jammed.count = 0;
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

/// The proxy's clearance shrinks with its object.
void shrinkClearance(const ObjectMotion& reference, DeviceState& state) noexcept {
    if (!reference.jumped && reference.workspaceFromObject.scale < reference.before.scale)
        state.clearance *= reference.workspaceFromObject.scale / reference.before.scale;
}

} // namespace

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
