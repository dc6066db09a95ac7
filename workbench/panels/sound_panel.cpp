#include "workbench/figures/quantity.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

namespace touchstone {

void drawSound(const PanelInput& input, PanelState& state, Widgets& widgets) {
    SoundChoice& sound = state.sound;
    const SoundStatus& status = input.sound;
    if (widgets.lampButton("sound", "Sound", sound.on, status.card.empty() ? kAmber : kGreen))
        sound.on = !sound.on;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    float percent = 100.0f * sound.volume;
    if (widgets.slider("volume", "volume", percent, {.low = 0.0f, .high = 100.0f, .clamp = true},
                       figure(static_cast<double>(percent), 2) + " %"))
        sound.volume = percent / 100.0f;
    if (!sound.on)
        return;
    widgets.wrapped(!status.problem.empty() ? status.problem
                    : status.card.empty()
                        ? "looking for a sound card"
                        : status.card + ", " + quantity(status.latency, "s", 2) + " after the force",
                    ImGui::GetColorU32(ImGuiCol_TextDisabled));
    widgets.mark("soundStatus");
}

} // namespace touchstone
