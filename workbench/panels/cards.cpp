#include "workbench/panels/card.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <string>

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

/// Width of a card's content: at most that of the picture.
float roomOf(const WidgetRect& picture, const Widgets& widgets) {
    return std::min(widgets.units(400.0f), picture.width - widgets.units(62.0f));
}

void loading(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (!input.loading)
        return;
    if (beginCard("loading", picture, 0.5f, 0.0f, widgets)) {
        const float room = roomOf(picture, widgets);
        ImGui::TextUnformatted(brokenLines("Opening " + input.loadName, room).c_str());
        ImGui::ProgressBar(static_cast<float>(input.loadFraction),
                           ImVec2(std::min(widgets.units(280.0f), room - Widgets::buttonWidth("Cancel") -
                                                                      ImGui::GetStyle().ItemSpacing.x),
                                  0.0f),
                           input.loadActivity.c_str());
        ImGui::SameLine();
        if (widgets.button("cancel", "Cancel"))
            state.cancelPressed = true;
    }
    ImGui::End();
}

/// The prompt for unsaved materials.
void unsaved(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (!state.leaving)
        return;
    if (beginCard("unsaved", picture, 0.5f, 0.5f, widgets, kAnsweredCard)) {
        const float room = roomOf(picture, widgets);
        ImGui::TextUnformatted(
            brokenLines(input.texturesEdited
                            ? "What touch has changed on " + input.modelName + " is not saved."
                            : "The changed materials of " + input.modelName + " are not saved.",
                        room)
                .c_str());
        float used = 0.0f;
        const auto answer = [&](const char* label, const char* name, PanelState::Leave choice) {
            const float width = Widgets::buttonWidth(label) + ImGui::GetStyle().ItemSpacing.x;
            if (used > 0.0f && used + width < room)
                ImGui::SameLine();
            else
                used = 0.0f;
            used += width;
            if (widgets.button(name, label))
                state.leave = choice;
        };
        if (input.canSaveMaterials)
            answer("Save (Enter)", "leaveSave", PanelState::Leave::Save);
        answer("Discard (D)", "leaveDiscard", PanelState::Leave::Discard);
        answer("Stay (Escape)", "leaveStay", PanelState::Leave::Stay);
    }
    ImGui::End();
}

void problem(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    if (input.problem.empty() || input.loading)
        return;
    if (beginCard("problem", picture, 0.5f, 0.0f, widgets)) {
        const float room = roomOf(picture, widgets);
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.95f, 0.5f, 0.42f, 1.0f));
        ImGui::TextUnformatted(brokenLines(input.problem, room).c_str());
        ImGui::PopStyleColor();
        if (input.scene != nullptr)
            ImGui::TextDisabled("%s", brokenLines(input.modelName + " stays open.", room).c_str());
        if (widgets.button("dismiss", "Dismiss"))
            state.dismissPressed = true;
    }
    ImGui::End();
}

} // namespace

void drawIntroduction(PanelState& state, const WidgetRect& strip, Widgets& widgets) {
    constexpr const char *kDone = "Got it", *kModels = "Gallery (Ctrl+G)";
    const ImGuiStyle& style = ImGui::GetStyle();
    const float margin = widgets.units(12.0f);
    ImGui::SetNextWindowPos(ImVec2(strip.x, strip.y));
    ImGui::SetNextWindowSize(ImVec2(strip.width, strip.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(margin, 0.0f));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.13f, 0.19f, 0.27f, 1.0f));
    ImGui::Begin("introduction", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
    const float buttons = Widgets::buttonWidth(kDone) + style.ItemSpacing.x + Widgets::buttonWidth(kModels),
                right = strip.width - margin - buttons;
    const bool mouse = state.device.empty() && !state.simulatedHand;
    const std::string text = brokenLines(
        std::string(mouse ? "Left drag on the model: touch and stroke it."
                          : "Another hand touches: choose Mouse on the left.") +
            " Switch Shading, Texture and Friction in the bar and watch the charts. Right drag: look around. "
            "Space: force off and on. F1: all keys.",
        right - 2.0f * margin);
    ImGui::SetCursorPosY(0.5f * (strip.height - ImGui::CalcTextSize(text.c_str()).y));
    ImGui::TextUnformatted(text.c_str());
    ImGui::SetCursorPos(ImVec2(right, 0.5f * (strip.height - ImGui::GetFrameHeight())));
    if (widgets.button("gotIt", kDone))
        state.introduced = true;
    ImGui::SameLine();
    if (widgets.button("otherModels", kModels))
        state.gallery = true;
    ImGui::End();
}

void drawCards(const PanelInput& input, PanelState& state, const WidgetRect& picture, Widgets& widgets) {
    loading(input, state, picture, widgets);
    problem(input, state, picture, widgets);
    unsaved(input, state, picture, widgets);
}

} // namespace touchstone
