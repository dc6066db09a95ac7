#pragma once
// Structs of the caller's to and from what a session works with.

#include "haptics/world/driven_objects.h"
#include "session/control_loop.h"
#include "session/session.h"
#include "touchstone/touchstone.h"

namespace touchstone::api {

/// Throws Refused.
[[nodiscard]] ControlConfig controlOf(const ts_session_options& options);

/// What the caller asks for, within what an object may do. Throws Refused.
[[nodiscard]] DrivenPose goalOf(const ts_pose& pose, const Similarity& rest);
[[nodiscard]] ts_pose poseOf(const DrivenPose& now, const Similarity& rest);

/// `usualStiffness`: N/m, where the caller gives none.
[[nodiscard]] ContactGoal goalOf(const ts_goal& given, double usualStiffness);

/// A hand's tick.
[[nodiscard]] ts_state stateOf(const TickRecord& tick, const Session& session, bool running);
/// What the device gets is the loop's; what is felt is, too, where it follows the caller.
void addControl(const ControlLoop::State& control, ts_state& state);

} // namespace touchstone::api
