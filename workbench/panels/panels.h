#pragma once
// One function and one file a panel; layout.cpp puts them in their places.

#include "workbench/panels/panel_state.h"

namespace touchstone {

/// File and view menus, effects, force, record, servo lamp, help.
void drawTopBar(const PanelInput& input, PanelState& state, Widgets& widgets);

/// What is held: mouse, simulated hand, a device.
void drawHand(const PanelInput& input, PanelState& state, Widgets& widgets);
/// The simulated hand's next stroke; -1: the one before. It becomes the hand.
void nextStroke(PanelState& state, int step);
/// "clutch", "force comes back", "zoom 2.0x", both or nothing.
[[nodiscard]] std::string workspaceText(const DeviceMapping& mapping);
/// The model's nodes, what is touched among them, and what was wrong with the file.
void drawScene(const PanelInput& input, PanelState& state, Widgets& widgets);
/// What the touched material is felt as, and which effects it has and why.
void drawTouched(const PanelInput& input, PanelState& state, Widgets& widgets);

/// The force and depth of now, and in what state the touch is.
void drawNow(const PanelInput& input, PanelState& state, Widgets& widgets);
/// Sound on and off, its volume and what became of it.
void drawSound(const PanelInput& input, PanelState& state, Widgets& widgets);
/// Every choice of method.
void drawConfigurations(PanelState& state, Widgets& widgets);
/// How punctual the servo is, and the picture.
void drawServo(const PanelInput& input, Widgets& widgets);

/// Force, depth, energy and time of a step over the last seconds, and what of them is recorded.
void drawCharts(const PanelInput& input, PanelState& state, Widgets& widgets);

/// What lies over the picture: loading, what went wrong, how to touch.
void drawCards(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets);
/// Pictures of our own scenes and of what was opened before, to open one; over all but the bar.
void drawGallery(const PanelInput& input, PanelState& state, const WidgetRect& place, Widgets& widgets);
/// Every key and what the pointer does.
void drawHelp(const PanelInput& input, PanelState& state, Widgets& widgets);

/// The state of the touch as a person would say it.
struct TouchLamp {
    const char* text;
    unsigned color; ///< ImU32
};
[[nodiscard]] TouchLamp touchLamp(const PanelInput& input, const PanelState& state);

} // namespace touchstone
