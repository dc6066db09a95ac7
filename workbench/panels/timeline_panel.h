#pragma once

#include "workbench/panels/widgets.h"

#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

class TimelineController;

/// View state of a recording.
struct TimelinePanelState {
    bool shown = false;     ///< the panel shows the recording, not the live charts
    bool list = false;      ///< the list of recordings, also while one is open
    bool looking = false;   ///< the controller's state in the last frame
    double span = 2.0;      ///< s, width of the near view
    double nearBegin = 0.0; ///< s, its start
    /// Requests of this frame; cleared by the code that handles them.
    std::optional<std::filesystem::path> open;
    /// Of the list: the recording whose name is being typed, or that waits for an answer before it is
    /// deleted.
    std::optional<std::filesystem::path> renaming, deleting;
    std::string name = std::string(256, '\0'); ///< the text being typed
    bool nameBegins = false;                   ///< the text field takes the keyboard
    std::string outcome;                       ///< of the last action: "deleted …", or the problem
    bool failed = false;
};

/// Shows a recording when it is opened and hides it when it is closed. True in the frame in which it was
/// opened.
bool followController(const TimelineController& controller, TimelinePanelState& state);

/// The recording's timeline, or the list of recordings where none is open. Applies input at once. Main
/// thread, within an ImGui window.
void drawTimeline(TimelineController& controller, TimelinePanelState& state, Widgets& widgets);

/// On the picture while a recording is open: a notice that the force is off, and the way back. `picture`: its
/// rectangle.
void drawLookingCard(TimelineController& controller, const WidgetRect& picture, Widgets& widgets);

/// K, arrows, Home and End, A and B. Within an ImGui frame without text input.
void timelineKeys(TimelineController& controller);

} // namespace touchstone
