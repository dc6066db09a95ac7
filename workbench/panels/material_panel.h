#pragma once
// The material editor's widgets.

#include "engine/scene/scene.h"
#include "workbench/editor/material_controller.h"
#include "workbench/panels/program_panel.h"
#include "workbench/panels/widgets.h"

namespace touchstone {

/// Input of the editor besides the controller. Pointers are valid during the call.
struct MaterialPanelInput {
    const Scene* scene = nullptr;   ///< null: no model yet
    int probed = -1;                ///< Scene::materials under the probe; -1: none
    double deviceStiffness = 600.0; ///< N/m, where a material states none
};

/// State of the editor between frames.
struct MaterialPanelState {
    size_t material = 0;        ///< of the file
    bool followProbe = true;    ///< show the touched material
    bool saveAsPressed = false; ///< ask for a file; cleared by the code that does
    ProgramPanelState program;
    float footer = 0.0f; ///< window coordinates, height of the last frame's buttons
};

/// Draws the editor into the current ImGui window and applies edits to the controller. Widget names:
/// "edit.material", "edit.preset", "edit.FIELD", "reset.FIELD", "undo", "redo", "resetMaterial", "save",
/// "saveAs", and those of drawProgram. Main thread, within an ImGui frame.
void drawMaterialPanel(const MaterialPanelInput& input, MaterialController& controller,
                       MaterialPanelState& state, Widgets& widgets);

} // namespace touchstone
