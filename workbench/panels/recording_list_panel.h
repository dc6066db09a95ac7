#pragma once

#include "workbench/panels/timeline_panel.h"

namespace touchstone {

/// The recordings in the state folder: a click opens one, buttons rename and delete it; deleting asks first.
/// Main thread, within an ImGui window, after the buttons of its first line.
void drawRecordingList(TimelineController& controller, TimelinePanelState& state, Widgets& widgets);

} // namespace touchstone
