#pragma once
// The material editor's widgets.

#include "engine/scene/scene.h"
#include "workbench/editor/material_controller.h"
#include "workbench/panels/widgets.h"

#include <string>

namespace touchstone {

/// What the editor shows besides the desk. Pointers live for the call.
struct MaterialPanelInput {
    const Scene* scene = nullptr;   ///< null: no model yet
    int probed = -1;                ///< Scene::materials under the probe; -1: none
    double deviceStiffness = 600.0; ///< N/m, where a material states none
};

/// What the editor remembers from frame to frame.
struct MaterialPanelState {
    size_t material = 0;     ///< of the file
    bool followProbe = true; ///< show what is touched
    std::string target;      ///< of "Save as"
    bool askTarget = false;
    float footer = 0.0f; ///< window coordinates that the last frame's buttons took
};

/// Draws the editor into the current ImGui window and makes the changes at the desk. Widgets are called
/// "edit.material", "edit.preset", "edit.FIELD", "reset.FIELD", "undo", "redo", "resetMaterial", "save",
/// "saveAs". Main thread, within an ImGui frame.
void drawMaterialPanel(const MaterialPanelInput& input, MaterialController& controller,
                       MaterialPanelState& state, Widgets& widgets);

} // namespace touchstone
