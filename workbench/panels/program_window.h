#pragma once

#include "workbench/editor/program_editor.h"
#include "workbench/panels/program_panel.h"
#include "workbench/panels/widgets.h"

namespace touchstone {

/// The text of the chosen program as a window, while it is open: initially over the right of `picture`
/// (window coordinates), never larger than that; with the numbers of its lines, and the problem at its line.
/// Widget names: "program.text", "program.revert", "program.problem" (its tooltip is the problem). Main
/// thread, within an ImGui frame.
void drawProgramWindow(const WidgetRect& picture, ProgramEditor& programs, ProgramPanelState& state,
                       Widgets& widgets);

} // namespace touchstone
