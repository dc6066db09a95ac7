#include "workbench/panels/material_window.h"

#include "workbench/panels/program_window.h"
#include "workbench/screen/keys.h"

#include <imgui.h>

#include <algorithm>
#include <string>

namespace touchstone {

namespace {

void materialKeys(MaterialController& controller, MaterialPanelState& state, bool undoes) {
    if (undoes && ctrlPressed(keyOf('z'), true)) {
        if (ImGui::GetIO().KeyShift)
            controller.edits().redo();
        else
            controller.edits().undo();
    }
    if (undoes && ctrlPressed(keyOf('y'), true))
        controller.edits().redo();
    if (ctrlPressed(keyOf('s')) && controller.edited()) {
        if (controller.canSaveInPlace())
            controller.save();
        else
            state.saveAsPressed = true;
    }
}

} // namespace

void drawMaterialWindow(const MaterialPanelInput& input, const WidgetRect& picture, bool& open,
                        MaterialController& controller, MaterialPanelState& state, Widgets& widgets,
                        bool undoes) {
    materialKeys(controller, state, undoes);
    drawProgramWindow(picture, controller.programs(), state.program, widgets);
    if (!open)
        return;
    constexpr float kWidth = 320.0f, kHeight = 610.0f, kWindowMargin = 8.0f; // units
    const float margin = widgets.units(kWindowMargin);
    const ImVec2 room(std::max(1.0f, picture.width - 2.0f * margin),
                      std::max(1.0f, picture.height - 2.0f * margin));
    ImGui::SetNextWindowPos(ImVec2(picture.x + margin, picture.y + margin), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(
        ImVec2(std::min(room.x, widgets.units(kWidth)), std::min(room.y, widgets.units(kHeight))),
        ImGuiCond_FirstUseEver);
    // Another scale begins with another window: one of the right size and place.
    const std::string title = "Material##" + std::to_string(widgets.units(1.0f));
    if (ImGui::Begin(title.c_str(), &open, ImGuiWindowFlags_NoSavedSettings))
        drawMaterialPanel(input, controller, state, widgets);
    ImGui::End();
}

} // namespace touchstone
