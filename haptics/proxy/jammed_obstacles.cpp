// Objects that leave the proxy no place.

#include "haptics/proxy/obstacle_search.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <array>

namespace touchstone {

namespace {

constexpr int kFollowRounds = 8;
/// Once a jammed object has moved on by this distance (its longest side is 1), touch begins again.
constexpr double kGivenUp = 0.5;

} // namespace

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

} // namespace touchstone
