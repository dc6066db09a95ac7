#pragma once
// One function and one file per panel; layout.cpp arranges them.

#include "workbench/panels/panel_state.h"

namespace touchstone {

/// File and view menus, effects, force, record, servo lamp, help.
void drawTopBar(const PanelInput& input, PanelState& state, Widgets& widgets);

/// The clipping plane: on and off, its direction and place. toggleClip: at first across the view, through the
/// middle of the model.
void drawClip(const PanelInput& input, PanelState& state, Widgets& widgets);
void toggleClip(const PanelInput& input, PanelState& state);

/// The hand in use: mouse, simulated hand, device.
void drawHand(const PanelInput& input, PanelState& state, Widgets& widgets);
/// Selects the simulated hand's next stroke (-1: previous) and switches to that hand.
void nextStroke(PanelState& state, int step);
/// "clutch", "force comes back", "zoom 2.0x", both or empty.
[[nodiscard]] std::string workspaceText(const DeviceMapping& mapping);
/// The tool shelf of sculpting.
void drawSculpt(const PanelInput& input, PanelState& state, Widgets& widgets);
/// Its keys, as Blender's: F resizes, Ctrl inverts, Shift smooths. While a recording is looked at B marks a
/// loop's end instead (timelineKeys).
void sculptKeys(SculptChoice& choice, bool looking);
/// The histogram and the value of the surface; nothing where the model is no volume.
void drawVolume(const PanelInput& input, PanelState& state, Widgets& widgets);
/// The model's animations: which plays, where it is, play, pause and speed; nothing where none plays.
void drawAnimation(const PanelInput& input, PanelState& state, Widgets& widgets);
/// The model's nodes with the touched one, and the file's warnings.
void drawScene(const PanelInput& input, PanelState& state, Widgets& widgets);
/// Effective properties of the touched material, and its effects with reasons.
void drawTouched(const PanelInput& input, PanelState& state, Widgets& widgets);

/// Current force and depth, and the state of touch; grey where the force is not sent to the device.
void drawNow(const PanelInput& input, PanelState& state, Widgets& widgets);
/// Sound on and off, volume and status.
void drawSound(const PanelInput& input, PanelState& state, Widgets& widgets);
/// The usual choices of method; --set has all.
void drawConfigurations(PanelState& state, Widgets& widgets);
/// Timing of the servo and of rendering.
void drawServo(const PanelInput& input, Widgets& widgets);

/// The chosen quantities over the last seconds, with the recorded intervals; which, and the files of them.
void drawCharts(const PanelInput& input, PanelState& state, Widgets& widgets);

/// How to touch, until it is dismissed: a strip beneath the bar.
void drawIntroduction(PanelState& state, const WidgetRect& strip, Widgets& widgets);
/// Cards over the picture: loading, problems, unsaved materials.
void drawCards(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets);
/// On the picture, for some seconds: where it was saved, or why it was not.
void drawSavedPicture(const PanelInput& input, const WidgetRect& picture, Widgets& widgets);
/// Pictures of our own and of recent scenes, to open one; over everything but the bar.
void drawGallery(const PanelInput& input, PanelState& state, const WidgetRect& place, Widgets& widgets);
/// All keys and pointer actions.
void drawHelp(const PanelInput& input, PanelState& state, Widgets& widgets);

/// The state of touch for the user.
struct TouchLamp {
    const char* text;
    unsigned color; ///< ImU32
};
[[nodiscard]] TouchLamp touchLamp(const PanelInput& input, const PanelState& state);

} // namespace touchstone
