#pragma once

#include "workbench/panels/material_panel.h"

namespace touchstone {

/// The material editor as a window, while it is `open`: initially over the upper left corner of `picture`
/// (window coordinates), never larger than that. Its keys work whether it is open or not: Ctrl+Z,
/// Ctrl+Shift+Z or Ctrl+Y, Ctrl+S. Main thread, within an ImGui frame.
void drawMaterialWindow(const MaterialPanelInput& input, const WidgetRect& picture, bool& open,
                        MaterialController& controller, MaterialPanelState& state, Widgets& widgets,
                        bool undoes = true);

} // namespace touchstone
