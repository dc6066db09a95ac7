#include "workbench/window/panels/panels.h"

#include <imgui.h>

#include <algorithm>

namespace touchstone {

namespace {

constexpr ImGuiWindowFlags kCard = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// A card on the picture: `x`, `y` say where on it and which of its own points lies there, 0..1.
bool beginCard(const char* name, const WidgetRect& picture, float x, float y, const Widgets& widgets) {
    const float margin = widgets.units(14.0f);
    ImGui::SetNextWindowPos(ImVec2(picture.x + margin + x * (picture.width - 2.0f * margin),
                                   picture.y + margin + y * (picture.height - 2.0f * margin)),
                            ImGuiCond_Always, ImVec2(x, y));
    ImGui::SetNextWindowBgAlpha(0.88f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, widgets.units(6.0f));
    const bool open = ImGui::Begin(name, nullptr, kCard);
    ImGui::PopStyleVar();
    return open;
}

void loading(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (!input.loading)
        return;
    if (beginCard("loading", picture, 0.5f, 0.0f, widgets)) {
        ImGui::Text("Opening %s", input.loadName.c_str());
        ImGui::ProgressBar(static_cast<float>(input.loadFraction), ImVec2(widgets.units(240.0f), 0.0f),
                           input.loadActivity.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Cancel"))
            state.cancelPressed = true;
        widgets.mark("cancel");
    }
    ImGui::End();
}

/// Before edited materials are lost.
void unsaved(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (!state.leaving)
        return;
    ImGui::SetNextWindowFocus(); // over the editor
    if (beginCard("unsaved", picture, 0.5f, 0.5f, widgets)) {
        ImGui::Text("What was changed in the materials of %s is not saved.", input.modelName.c_str());
        const auto answer = [&](const char* label, const char* name, PanelState::Leave choice) {
            if (ImGui::Button(label))
                state.leave = choice;
            widgets.mark(name);
            ImGui::SameLine();
        };
        if (input.canSaveMaterials)
            answer("Save", "leaveSave", PanelState::Leave::Save);
        answer("Discard", "leaveDiscard", PanelState::Leave::Discard);
        answer("Stay", "leaveStay", PanelState::Leave::Stay);
        ImGui::NewLine();
    }
    ImGui::End();
}

void problem(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (input.problem.empty() || input.loading)
        return;
    if (beginCard("problem", picture, 0.5f, 0.0f, widgets)) {
        ImGui::PushTextWrapPos(std::min(widgets.units(380.0f), picture.width - widgets.units(34.0f)));
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.95f, 0.5f, 0.42f, 1.0f));
        ImGui::TextUnformatted(input.problem.c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        if (input.scene != nullptr)
            ImGui::TextDisabled("%s is still there.", input.modelName.c_str());
        if (ImGui::Button("Dismiss"))
            state.dismissPressed = true;
        widgets.mark("dismiss");
    }
    ImGui::End();
}

/// Three lines, until they were read; they wait while something else lies where they would.
void introduction(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (state.introduced || input.loading || input.scene == nullptr || state.editMaterials ||
        state.view.mode != ViewMode::Shaded)
        return;
    if (beginCard("introduction", picture, 0.5f, 1.0f, widgets)) {
        ImGui::PushTextWrapPos(std::min(widgets.units(440.0f), picture.width - widgets.units(34.0f)));
        const bool mouse = state.device.empty() && !state.simulatedHand;
        ImGui::TextUnformatted(
            mouse ? "Point at the model and press the left button to touch it; drag to stroke it."
                  : "Another hand touches; choose Mouse on the left to touch yourself.");
        ImGui::TextUnformatted("Drag with the right button to look from elsewhere.");
        ImGui::TextUnformatted("Space switches the force off and on; F1 tells the rest.");
        ImGui::PopTextWrapPos();
        if (ImGui::Button("Got it"))
            state.introduced = true;
        widgets.mark("gotIt");
    }
    ImGui::End();
}

} // namespace

void drawCards(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    loading(input, state, picture, widgets);
    problem(input, state, picture, widgets);
    unsaved(input, state, picture, widgets);
    introduction(input, state, picture, widgets);
}

void drawHelp(const PanelInput& input, PanelState& state, Widgets& widgets) {
    if (!state.help)
        return;
    constexpr const char* kLines[][2]{
        {"Left button, drag", "touches what is pointed at, and strokes it"},
        {"Wheel", "presses harder or more lightly"},
        {"G", "the mouse moves its hand free in space: left drag, and the wheel in depth"},
        {"Right or middle drag", "turns the view; with Shift shifts it, with Ctrl zooms"},
        {"Alt + left drag", "turns the view, too"},
        {"Ctrl + wheel, + and -", "zooms"},
        {"Arrow keys; with Shift", "turn the view; shift it"},
        {"Home or F", "shows all"},
        {"1, 3, 7; with Ctrl", "from the front, the right, above; the other side"},
        {". and T", "near the probe; turntable"},
        {"V; with Shift", "the next view; the one before"},
        {"M and O", "magnifier; overlays"},
        {"F12", "saves the picture"},
        {"Space", "switches the force off and on"},
        {"S", "lets the force be heard"},
        {"F5, F6, F7", "switch shading, texture and friction"},
        {"F8", "changes between mouse and simulated hand"},
        {"N; with Shift", "the simulated hand's next stroke; the one before"},
        {"F9", "begins and ends a recording"},
        {"E", "opens and closes the material editor"},
        {"Ctrl+Z, Ctrl+Shift+Z", "takes a change of a material back, makes it again"},
        {"Ctrl+S", "saves the materials into the file"},
        {"P", "pauses the charts"},
        {"F2, F3, F4; Tab", "fold the scene, what is felt, the charts; all"},
        {"Ctrl + O", "opens a file by its path; one may be dropped here, too"},
        {"Ctrl + Q", "quits"},
        {"F1 or ?, Escape", "shows this; puts it away"},
    };
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowBgAlpha(1.0f);
    ImGui::SetNextWindowFocus();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, widgets.units(6.0f));
    if (ImGui::Begin("help", nullptr, kCard)) {
        ImGui::TextDisabled("POINTER AND KEYS");
        ImGui::Separator();
        for (const auto& [key, meaning] : kLines) {
            ImGui::TextUnformatted(key);
            ImGui::SameLine(widgets.units(200.0f));
            ImGui::TextDisabled("%s", meaning);
        }
        ImGui::Separator();
        ImGui::TextDisabled("%s, %d x %d", input.gpuName.c_str(), input.sceneSize.x, input.sceneSize.y);
        if (ImGui::Button("Close"))
            state.help = false;
        widgets.mark("helpClose");
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

} // namespace touchstone
