#include "haptics/world/driven_objects.h"

#include "engine/scene/animation.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kMostStep = 0.01; // s

/// From `now` towards `goal` by at most `angle` rad, the shorter way.
glm::dquat turnedTowards(const glm::dquat& now, const glm::dquat& goal, double angle) {
    glm::dquat turn = goal * glm::conjugate(now);
    if (turn.w < 0.0)
        turn = -turn;
    const glm::dvec3 axis{turn.x, turn.y, turn.z};
    const double sine = glm::length(axis), whole = 2.0 * std::atan2(sine, turn.w);
    if (!(whole > angle))
        return goal;
    return glm::normalize(glm::dquat(std::cos(0.5 * angle), std::sin(0.5 * angle) / sine * axis) * now);
}

} // namespace

std::string drivenProblem(const Scene& source, const HapticScene& haptic, size_t object) {
    if (object >= haptic.objects.size())
        return std::to_string(object) + ", and there are " + std::to_string(haptic.objects.size());
    if (source.physics != nullptr)
        return "cannot be moved: the scene has rigid bodies, which move by themselves";
    if (haptic.objects[object]->instance < 0)
        return "cannot be moved: it is no object of the file";
    const Animation* const animation = playedAnimation(source);
    const auto instance = static_cast<size_t>(haptic.objects[object]->instance);
    if (animation != nullptr &&
        animates(source, *animation, movedNodes(source, *animation), source.instances[instance]))
        return "cannot be moved: the animation moves it";
    return {};
}

Similarity drivenAfter(const DrivenPose& pose, double dt) noexcept {
    const double step = std::clamp(dt, 0.0, kMostStep);
    Similarity after = pose.goal;
    const glm::dvec3 way = pose.goal.translation - pose.now.translation;
    const double length = glm::length(way), reach = pose.speed * step;
    if (length > reach)
        after.translation = pose.now.translation + way * (reach / length);
    after.rotation = turnedTowards(pose.now.rotation, pose.goal.rotation, pose.turn * step);
    return after;
}

bool DrivenObjects::drive(int object, const Similarity& rest, const Similarity& goal, double speed,
                          double turn) noexcept {
    size_t slot = 0;
    while (slot < wanted_.count && wanted_.goals[slot].object != object)
        ++slot;
    if (slot == kMostDriven)
        return false;
    wanted_.count = std::max(wanted_.count, static_cast<uint32_t>(slot + 1));
    wanted_.goals[slot] = {object, rest, goal, speed, turn, false};
    goals_.write(wanted_);
    return true;
}

void DrivenObjects::halt() noexcept {
    for (Goal& goal : wanted_.goals)
        goal.halted = true;
    goals_.write(wanted_);
}

const DrivenState* DrivenObjects::before(uint64_t tick) noexcept {
    while (!popped_ || popped_->tick < tick) {
        DrivenState next;
        if (!kept_.pop(next))
            return nullptr;
        popped_ = next;
    }
    return popped_->tick == tick ? &*popped_ : nullptr;
}

void DrivenObjects::forgetKept() noexcept {
    DrivenState old;
    while (kept_.pop(old))
        continue;
    popped_.reset();
}

void DrivenObjects::begin(uint64_t tick, double dt, bool keep) noexcept {
    dt_ = dt;
    state_.tick = tick;
    const bool came = goals_.update();
    const Goals& wanted = goals_.value();
    for (uint32_t slot = 0; came && slot < wanted.count; ++slot) {
        const Goal& goal = wanted.goals[slot];
        DrivenPose& pose = state_.objects[slot];
        if (slot >= state_.count)
            pose.now = goal.rest;
        pose.object = goal.object;
        pose.goal = goal.halted ? pose.now : goal.goal;
        pose.speed = goal.speed;
        pose.turn = goal.turn;
    }
    if (came)
        state_.count = wanted.count;
    if (came || keep)
        kept_.push(state_);
}

void DrivenObjects::advance(std::span<ObjectMotion> motions, bool first) noexcept {
    for (DrivenPose& pose : std::span(state_.objects).first(state_.count)) {
        ObjectMotion& motion = motions[static_cast<size_t>(pose.object)];
        motion.before = motion.workspaceFromObject;
        motion.jumped = false;
        pose.now = drivenAfter(pose, dt_);
        motion.workspaceFromObject = pose.now;
        if (first)
            motion.before = pose.now;
    }
    dt_ = 0.0;
    shown_.write(state_);
}

void DrivenObjects::addTo(Hash64& hash) const noexcept {
    for (const DrivenPose& pose : state_.poses()) {
        hash.add(pose.object);
        for (const double number :
             {pose.now.scale, pose.now.rotation.x, pose.now.rotation.y, pose.now.rotation.z,
              pose.now.rotation.w, pose.now.translation.x, pose.now.translation.y, pose.now.translation.z})
            hash.add(number);
    }
}

} // namespace touchstone
