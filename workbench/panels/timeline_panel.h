#pragma once

#include "workbench/panels/widgets.h"

#include <filesystem>
#include <optional>

namespace touchstone {

class TimelineController;

/// What a person has chosen about how a recording is shown.
struct TimelinePanelState {
    bool shown = false;     ///< the panel below has the recording, not the live charts
    bool list = false;      ///< the recordings that there are, also while one is looked at
    bool looking = false;   ///< as the desk was in the last frame
    double span = 2.0;      ///< s that the near view shows
    double nearBegin = 0.0; ///< s, where it begins
    /// Asked for in this frame; whoever does it takes it back.
    std::optional<std::filesystem::path> open;
};

/// What is looked at is shown, and what is left is not. True where somebody has just begun to look.
bool followController(const TimelineController& controller, TimelinePanelState& state);

/// The recording's timeline, or the list of recordings where none is looked at. What is pressed and dragged
/// is done at once. Main thread, within an ImGui window.
void drawTimeline(TimelineController& controller, TimelinePanelState& state, Widgets& widgets);

/// On the picture while a recording is looked at: that the force is off, and the way back. `picture`: its
/// place.
void drawLookingCard(TimelineController& controller, const WidgetRect& picture, Widgets& widgets);

/// K, arrows, Home and End, A and B. Within an ImGui frame in which nobody types.
void timelineKeys(TimelineController& controller);

} // namespace touchstone
