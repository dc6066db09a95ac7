#pragma once

#include "workbench/panels/widgets.h"

namespace touchstone {

class TimelineController;
struct TimelinePanelState;

/// The whole recording in `height` window coordinates: the force, where it touches, marks, cursor. Scrubs.
void drawOverview(TimelineController& controller, float height, Widgets& widgets);

/// What is near the cursor, with what was felt again over it. Scrubs; the wheel changes how much is shown.
void drawNear(TimelineController& controller, TimelinePanelState& state, float height, Widgets& widgets);

} // namespace touchstone
