#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace touchstone {

namespace {

void letGo(PanelState& state, bool simulate) {
    state.simulatedHand = simulate;
    state.device.clear();
}

/// Plugged-in devices.
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

/// Stroke, speed and depth.
void strokes(const PanelInput& input, PanelState& state, Widgets& widgets) {
    StrokeRequest& stroke = state.stroke;
    const StrokeInfo& chosen = *findStroke(stroke.name);
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::BeginCombo("##stroke", stroke.name.c_str(), ImGuiComboFlags_HeightLarge)) {
        for (const StrokeInfo& info : strokeInfos()) {
            if (ImGui::Selectable(std::string(info.name).c_str(), info.name == stroke.name))
                stroke = {.name = std::string(info.name)};
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip("%s", std::string(info.meaning).c_str());
        }
        ImGui::EndCombo();
    }
    widgets.mark("stroke");
    const auto slider = [&](const char* name, double& value, double own, double most, double unit,
                            const char* format) {
        auto shown = static_cast<float>((value > 0.0 ? value : own) * unit);
        constexpr float kLeastOfMost = 0.02f;
        const auto high = static_cast<float>(most * unit);
        ImGui::SliderFloat((std::string("##") + name).c_str(), &shown, kLeastOfMost * high, high, format,
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
        // Laid again on release, not at every pixel of the drag.
        float& dragged = *ImGui::GetStateStorage()->GetFloatRef(ImGui::GetID(name), shown);
        if (ImGui::IsItemActive())
            dragged = shown;
        if (ImGui::IsItemDeactivatedAfterEdit())
            value = dragged / unit;
        widgets.mark(name);
    };
    slider("strokeSpeed", stroke.speed, chosen.speed, 1.0, 1e3, "%.0f mm/s");
    slider("strokeDepth", stroke.depth, chosen.depth, kDeepestStroke, 1e3, "%.1f mm deep");
    ImGui::PopItemWidth();
    if (!input.strokeNotice.empty())
        ImGui::TextWrapped("%s", input.strokeNotice.c_str());
}

/// Clutch and zoom of hands with a workspace map.
void workspace(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const DeviceMapping& mapping = input.servo->last.sample.mapping;
    auto zoom = static_cast<float>(state.workspace.zoom);
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::SliderFloat("##zoom", &zoom, static_cast<float>(kMinZoom), static_cast<float>(kMaxZoom),
                           "zoom %.2fx", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        state.workspace.zoom = static_cast<double>(zoom);
    widgets.mark("zoom");
    ImGui::PopItemWidth();
    ImGui::Button("Clutch (hold C)");
    if (ImGui::IsItemActive())
        state.workspace.clutch = true;
    widgets.mark("clutch");
    ImGui::SameLine();
    if (ImGui::Button("Centre"))
        state.centrePressed = true;
    widgets.mark("centre");
    const std::string text = workspaceText(mapping);
    if (!text.empty())
        ImGui::TextColored(ImVec4(0.95f, 0.72f, 0.25f, 1.0f), "%s", text.c_str());
    const double scale = mapping.workspaceFromDevice.scale;
    if (scale > 1.0) {
        const DeviceLimits& limits = input.servo->last.sample.limits;
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped("600 N/m feel like %.0f; the device bears %.0f",
                           std::min(600.0 * scale, limits.maxStiffness), limits.maxStiffness);
        ImGui::PopStyleColor();
    }
}

} // namespace

std::string workspaceText(const DeviceMapping& mapping) {
    std::string text = mapping.coupling >= 1.0   ? ""
                       : mapping.coupling <= 0.0 ? "clutch"
                                                 : "clutch: force fades";
    const double zoom = mapping.workspaceFromDevice.scale;
    if (std::abs(zoom - 1.0) > 1e-3) {
        std::array<char, 32> number{};
        std::snprintf(number.data(), number.size(), "zoom %.3gx", zoom);
        text += (text.empty() ? "" : ", ") + std::string(number.data());
    }
    return text;
}

void nextStroke(PanelState& state, int step) {
    const auto infos = strokeInfos();
    const auto count = static_cast<int>(infos.size());
    const int at = static_cast<int>(findStroke(state.stroke.name) - infos.data());
    if (state.simulatedHand && state.device.empty())
        state.stroke = {.name = std::string(infos[static_cast<size_t>((at + step + count) % count)].name)};
    letGo(state, true);
}

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
    if (!held && state.simulatedHand)
        strokes(input, state, widgets);
    if (!held && !state.simulatedHand) {
        ImGui::Checkbox("free in space", &state.view.freeHand);
        widgets.mark("freeHand");
        if (!state.view.freeHand)
            ImGui::TextDisabled("presses with %.2f N", state.view.press);
    }
    if (held || !input.devices.empty())
        devices(input, state, widgets);
    if (held || state.simulatedHand)
        workspace(input, state, widgets);
    if (!input.deviceStatus.empty())
        ImGui::TextWrapped("%s", input.deviceStatus.c_str());
}

} // namespace touchstone
