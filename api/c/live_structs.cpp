#include "api/c/live_structs.h"

#include "api/c/calls.h"
#include "api/c/live_hand.h"

#include <algorithm>
#include <cmath>

namespace touchstone::api {

namespace {

void setVector(double (&out)[3], const glm::dvec3& value) {
    for (int axis = 0; axis < 3; ++axis)
        out[axis] = value[axis];
}

} // namespace

ControlConfig controlOf(const ts_session_options& options) {
    ControlConfig control;
    if (!(options.control >= kMinServoRate && options.control <= kMaxServoRate))
        refuseArgument("options.control", "is not within 100 .. 4000 Hz");
    control.rateHz = options.control;
    control.contactPower = limitOr(options.contact_power, control.contactPower, "options.contact_power");
    control.goalPower = limitOr(options.goal_power, control.goalPower, "options.goal_power");
    return control;
}

DrivenPose goalOf(const ts_pose& pose, const Similarity& rest) {
    DrivenPose goal;
    goal.goal = rest;
    goal.speed = limitOr(pose.speed, 0.1, "pose.speed");
    goal.turn = limitOr(pose.turn, 1.0, "pose.turn");
    if (goal.speed > kMostDriveSpeed)
        refuseArgument("pose.speed", "is above 0.5 m/s");
    if (goal.turn > kMostDriveTurn)
        refuseArgument("pose.turn", "is above 6.3 rad/s");
    goal.goal.translation = {pose.position[0], pose.position[1], pose.position[2]};
    if (!(glm::length(goal.goal.translation) <= 1.0))
        refuseArgument("pose.position", "is not within 1 m of the origin");
    const glm::dquat turn{pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]};
    const double length = glm::length(turn);
    if (length != 0.0 && !(std::abs(length - 1.0) < 1e-3))
        refuseArgument("pose.orientation", "is no unit quaternion");
    if (length != 0.0)
        goal.goal.rotation = glm::normalize(turn / length * rest.rotation);
    return goal;
}

ts_pose poseOf(const DrivenPose& now, const Similarity& rest) {
    const glm::dquat turned = glm::normalize(now.now.rotation * glm::conjugate(rest.rotation));
    ts_pose pose{};
    setVector(pose.position, now.now.translation);
    pose.orientation[0] = turned.w;
    pose.orientation[1] = turned.x;
    pose.orientation[2] = turned.y;
    pose.orientation[3] = turned.z;
    pose.speed = now.speed;
    pose.turn = now.turn;
    return pose;
}

ContactGoal goalOf(const ts_goal& given, double usualStiffness) {
    ContactGoal goal{.touching = given.touching != 0,
                     .proxy = {given.proxy[0], given.proxy[1], given.proxy[2]},
                     .stiffness = given.stiffness != 0.0 ? given.stiffness : usualStiffness,
                     .damping = given.damping,
                     .planeCount = static_cast<uint32_t>(std::min<size_t>(given.plane_count, 4))};
    for (size_t i = 0; i < goal.planes.size(); ++i)
        goal.planes[i] = {given.planes[i][0], given.planes[i][1], given.planes[i][2]};
    return goal;
}

ts_state stateOf(const TickRecord& tick, const Session& session, bool running) {
    ts_state state{};
    const ServoLoop::Counters counters = session.servo().counters();
    state.touching = session.touches(tick) ? 1 : 0;
    state.tick = tick.tick;
    state.time = tick.time;
    setVector(state.hip, tick.output.hip);
    setVector(state.proxy, tick.output.proxy);
    setVector(state.normal, tick.output.normal);
    setVector(state.force, tick.output.force);
    setVector(state.command, tick.output.commandInWorkspace);
    state.penetration = tick.output.penetration;
    state.contacts = tick.output.contacts;
    state.friction = static_cast<uint32_t>(tick.output.friction);
    state.flags = tick.output.flags;
    state.object = tick.output.object;
    state.started = 1e-9 * static_cast<double>(session.servo().startedNs());
    state.wake_ns = tick.wakeLatencyNs;
    state.step_ns = tick.stepNs;
    state.ticks = counters.ticks;
    state.missed = counters.missed;
    state.skipped = counters.skipped;
    state.dropped = counters.droppedRecords;
    state.realtime = running && session.servo().scheduling().policy.starts_with("SCHED_FIFO") ? 1 : 0;
    return state;
}

void addControl(const ControlLoop::State& control, ts_state& state) {
    state.control_ticks = control.ticks;
    state.control_missed = control.missed;
    setVector(state.command, control.command);
    if (static_cast<GoalSource>(control.source) != GoalSource::Caller)
        return;
    state.rendered = 1;
    setVector(state.hip, control.hip);
    setVector(state.proxy, control.end);
    setVector(state.force, control.force);
    setVector(state.normal, glm::dvec3(0.0));
    state.penetration = glm::length(control.end - control.hip);
    state.contacts = control.holds && state.penetration > 0.0 ? 1 : 0;
    state.friction = 0;
    state.flags = control.flags;
    state.object = -1;
}

} // namespace touchstone::api
