#include "workbench/panels/card.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"

#include <algorithm>

namespace touchstone {

void drawSavedPicture(const PanelInput& input, const WidgetRect& picture, Widgets& widgets) {
    constexpr double kShown = 8.0, kProblemShown = 30.0; // s
    const SavedNote& saved = input.savedPicture;
    const bool failed = !saved.problem.empty();
    if (saved.text().empty() || input.now - saved.at > (failed ? kProblemShown : kShown))
        return;
    const float margin = widgets.units(12.0f);
    ImGui::SetNextWindowPos(ImVec2(picture.x + margin, picture.y + margin), ImGuiCond_Always);
    ImGui::SetNextWindowBgAlpha(0.88f);
    if (beginCardWindow("saved", widgets, kCardFlags | ImGuiWindowFlags_NoInputs)) {
        ImGui::PushTextWrapPos(std::max(widgets.units(120.0f), picture.width - 4.0f * margin));
        ImGui::PushStyleColor(ImGuiCol_Text, failed ? kRed : kGreen);
        ImGui::TextUnformatted(saved.text().c_str());
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        widgets.mark("savedPicture");
    }
    ImGui::End();
}

} // namespace touchstone
