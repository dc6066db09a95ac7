#pragma once

#include "workbench/panels/widgets.h"

namespace touchstone {

class TimelineController;
struct TimelinePanelState;

/// The whole recording in `height` window coordinates: force, contact, marks, cursor. Scrubs.
void drawOverview(TimelineController& controller, float height, Widgets& widgets);

/// The interval around the cursor, with the replayed force. Scrubs; the wheel zooms.
void drawNear(TimelineController& controller, TimelinePanelState& state, float height, Widgets& widgets);

} // namespace touchstone
