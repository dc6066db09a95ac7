#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

namespace touchstone {

void drawSound(const PanelInput& input, PanelState& state, Widgets& widgets) {
    SoundChoice& sound = state.sound;
    const SoundStatus& status = input.sound;
    if (widgets.lampButton("sound", "Sound", sound.on, status.card.empty() ? kAmber : kGreen))
        sound.on = !sound.on;
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("S: lets the force be heard; texture sounds as it is stroked");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    float percent = 100.0f * sound.volume;
    if (ImGui::SliderFloat("##volume", &percent, 0.0f, 100.0f, "volume %.0f %%",
                           ImGuiSliderFlags_AlwaysClamp))
        sound.volume = percent / 100.0f;
    widgets.mark("volume");
    if (!sound.on)
        return;
    ImGui::PushTextWrapPos(0.0f);
    if (!status.problem.empty())
        ImGui::TextDisabled("%s", status.problem.c_str());
    else if (status.card.empty())
        ImGui::TextDisabled("looking for a sound card");
    else
        ImGui::TextDisabled("%s, %.0f ms after the force", status.card.c_str(), 1e3 * status.latency);
    ImGui::PopTextWrapPos();
    widgets.mark("soundStatus");
}

} // namespace touchstone
