#pragma once
// The haptic program of a material: what it costs, and sliders of its parameters.

#include "workbench/editor/material_controller.h"
#include "workbench/panels/widgets.h"

#include <cstddef>
#include <string>

namespace touchstone {

/// Between frames.
struct ProgramPanelState {
    bool open = false; ///< the window with the text
    size_t source = 0; ///< whose text
    std::string text;  ///< while it is typed
};

/// "232 instructions, 734 ns a tick, 2,127 ns with gradients".
[[nodiscard]] std::string costText(const ProgramCost& cost);
/// "line 4: 'colour' : undeclared identifier; see …"; empty: no problem.
[[nodiscard]] std::string problemText(const EditedProgram& program);

/// Draws them into the current ImGui window; edits are steps of the controller's. Widget names:
/// "edit.shader.NAME", or "edit.shader.NAME.x" of a vector's component, "reset.shader.NAME", "reset.shader",
/// "program.edit". Main thread, within an ImGui frame.
void drawProgram(size_t material, MaterialController& controller, ProgramPanelState& state, Widgets& widgets);

} // namespace touchstone
