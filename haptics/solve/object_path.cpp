#include "haptics/solve/object_path.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Below this angle (rad) the origin's arc and its chord differ by less than a thousandth of its path, and
/// the screw axis, a path divided by an angle away, loses digits.
constexpr double kSmallTurn = 1e-3;

} // namespace

// The origin moves by d across the axis u while the object turns by a. Seen along u it moves along an arc
// with the chord d, so it starts from the axis at the arm -(d / 2 + u x d / (2 tan(a / 2))).
ObjectPath::ObjectPath(const ObjectMotion& motion) noexcept : motion_(motion) {
    const Similarity &from = motion.before, &to = motion.workspaceFromObject;
    glm::dquat turn = to.rotation * glm::conjugate(from.rotation);
    if (turn.w < 0.0)
        turn = -turn;
    const glm::dvec3 sine(turn.x, turn.y, turn.z);
    const double length = glm::length(sine);
    if (length == 0.0)
        return;
    axis_ = sine / length;
    angle_ = 2.0 * std::atan2(length, turn.w);
    screw_ = angle_ > kSmallTurn && std::abs(to.scale - from.scale) < 1e-9 * from.scale;
    if (!screw_)
        return;
    const glm::dvec3 way = to.translation - from.translation;
    along_ = glm::dot(way, axis_) * axis_;
    const glm::dvec3 across = way - along_;
    arm_ = -0.5 * (across + glm::cross(axis_, across) / std::tan(0.5 * angle_));
}

Similarity ObjectPath::at(double time) const noexcept {
    const Similarity &from = motion_.before, &to = motion_.workspaceFromObject;
    if (time >= 1.0)
        return to;
    Similarity pose{from.scale + time * (to.scale - from.scale), from.rotation,
                    from.translation + time * (to.translation - from.translation)};
    if (angle_ > 0.0) {
        const glm::dquat turn = glm::angleAxis(time * angle_, axis_);
        pose.rotation = glm::normalize(turn * from.rotation);
        if (screw_)
            pose.translation = from.translation - arm_ + turn * arm_ + time * along_;
    }
    return pose;
}

double ObjectPath::longestWay(double radius) const noexcept {
    const Similarity &from = motion_.before, &to = motion_.workspaceFromObject;
    // An arc of at most half a turn is no longer than pi / 2 chords.
    return 1.6 * glm::length(to.translation - from.translation) +
           radius * (angle_ * std::max(from.scale, to.scale) + std::abs(to.scale - from.scale));
}

} // namespace touchstone
