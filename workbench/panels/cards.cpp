#include "workbench/panels/card.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>

namespace touchstone {

namespace {

/// A card on the picture: `x`, `y` give its anchor on the picture and on the card itself, 0..1.
bool beginCard(const char* name, const WidgetRect& picture, float x, float y, const Widgets& widgets,
               ImGuiWindowFlags flags = kCardFlags) {
    const float margin = widgets.units(14.0f);
    ImGui::SetNextWindowPos(ImVec2(picture.x + margin + x * (picture.width - 2.0f * margin),
                                   picture.y + margin + y * (picture.height - 2.0f * margin)),
                            ImGuiCond_Always, ImVec2(x, y));
    ImGui::SetNextWindowBgAlpha(0.88f);
    return beginCardWindow(name, widgets, flags);
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

/// The prompt for unsaved materials.
void unsaved(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (!state.leaving)
        return;
    if (beginCard("unsaved", picture, 0.5f, 0.5f, widgets, kAnsweredCard)) {
        ImGui::Text("What was changed in the materials of %s is not saved.", input.modelName.c_str());
        const auto answer = [&](const char* label, const char* name, PanelState::Leave choice) {
            if (ImGui::Button(label))
                state.leave = choice;
            widgets.mark(name);
            ImGui::SameLine();
        };
        if (input.canSaveMaterials)
            answer("Save (Enter)", "leaveSave", PanelState::Leave::Save);
        answer("Discard (D)", "leaveDiscard", PanelState::Leave::Discard);
        answer("Stay (Escape)", "leaveStay", PanelState::Leave::Stay);
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

/// Three lines until dismissed; hidden while another card occupies their place.
void introduction(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (state.introduced || input.loading || input.scene == nullptr || state.editMaterials || state.gallery ||
        state.timeline.looking || state.view.mode != ViewMode::Shaded)
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
        ImGui::SameLine();
        if (ImGui::Button("Other models (Ctrl+G)"))
            state.gallery = true;
        widgets.mark("otherModels");
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

} // namespace touchstone
