#include "workbench/window/panels/panels.h"

#include <imgui.h>

namespace touchstone {

namespace {

void letGo(PanelState& state, bool simulate) {
    state.simulatedHand = simulate;
    state.device.clear();
}

/// What is plugged in.
void devices(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const char* shown = state.device.empty() ? "hold a device" : state.device.c_str();
    for (const DeviceOffer& offer : input.devices)
        if (offer.choice == state.device)
            shown = offer.name.c_str();
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::BeginCombo("##device", shown)) {
        for (const DeviceOffer& offer : input.devices)
            if (ImGui::Selectable((offer.name + "  " + offer.choice).c_str(), offer.choice == state.device))
                state.device = offer.choice;
        ImGui::EndCombo();
    }
    widgets.mark("device");
    ImGui::PopItemWidth();
}

} // namespace

void drawHand(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const bool held = !state.device.empty();
    if (ImGui::RadioButton("Mouse", !held && !state.simulatedHand))
        letGo(state, false);
    widgets.mark("mouse");
    ImGui::SameLine();
    if (!input.canSimulate)
        ImGui::BeginDisabled();
    if (ImGui::RadioButton("Simulated hand", !held && state.simulatedHand))
        letGo(state, true);
    widgets.mark("simulatedHand");
    if (!input.canSimulate)
        ImGui::EndDisabled();
    if (!held && !state.simulatedHand) {
        ImGui::Checkbox("free in space", &state.view.freeHand);
        widgets.mark("freeHand");
        if (!state.view.freeHand)
            ImGui::TextDisabled("presses with %.2f N", state.view.press);
    }
    if (held || !input.devices.empty())
        devices(input, state, widgets);
    if (!input.deviceStatus.empty())
        ImGui::TextWrapped("%s", input.deviceStatus.c_str());
}

} // namespace touchstone
