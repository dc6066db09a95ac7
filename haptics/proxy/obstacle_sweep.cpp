// How a copy of the proxy moves in the frame of its object, and what stops it there.

#include "haptics/contact/near_contacts.h"
#include "haptics/contact/sweep.h"
#include "haptics/proxy/obstacle_search.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// A move shorter than this is rounding, object units.
constexpr double kNoMove = 1e-12;
/// Of the distance that the proxy keeps: what a moving triangle leaves it within a step. At the step's end it
/// is the whole distance.
constexpr double kLeftInStep = 0.5;

} // namespace

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

} // namespace touchstone
