#include "workbench/figures/quantity.h"
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
        for (const DeviceOffer& offer : input.devices) {
            if (ImGui::Selectable((offer.name + "  " + offer.choice).c_str(), offer.choice == state.device))
                state.device = offer.choice;
            widgets.mark(("device:" + offer.choice).c_str());
        }
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
            widgets.mark(("stroke:" + std::string(info.name)).c_str(), info.meaning);
        }
        ImGui::EndCombo();
    }
    widgets.mark("stroke");
    // `unit`: of the typed value.
    const auto slider = [&](const char* name, const char* label, double& value, double own, double most,
                            const ShownUnit& unit) {
        constexpr float kLeastOfMost = 0.02f;
        const auto high = static_cast<float>(most / unit.size);
        // Laid again on release, not at every pixel of the drag: until then the value is here.
        ImGuiStorage& storage = *ImGui::GetStateStorage();
        const ImGuiID dragged = ImGui::GetID(name);
        const auto set = static_cast<float>((value > 0.0 ? value : own) / unit.size);
        float shown = storage.GetFloat(dragged, 0.0f) > 0.0f ? storage.GetFloat(dragged) : set;
        widgets.slider(name, label, shown,
                       {.low = kLeastOfMost * high, .high = high, .logarithmic = true, .clamp = true},
                       quantity(unit.size * static_cast<double>(shown), unit));
        if (ImGui::IsItemDeactivatedAfterEdit())
            value = unit.size * static_cast<double>(shown);
        storage.SetFloat(dragged, ImGui::IsItemActive() ? shown : 0.0f);
    };
    slider("strokeSpeed", "speed", stroke.speed, chosen.speed, 1.0, {1e-3, "mm/s"});
    slider("strokeDepth", "depth", stroke.depth, chosen.depth, kDeepestStroke, {1e-3, "mm"});
    ImGui::PopItemWidth();
    if (!input.strokeNotice.empty())
        widgets.wrapped(input.strokeNotice);
}

/// Clutch and zoom of hands with a workspace map.
void workspace(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const DeviceMapping& mapping = input.servo->last.sample.mapping;
    auto zoom = static_cast<float>(state.workspace.zoom);
    ImGui::PushItemWidth(-1.0f);
    if (widgets.slider("zoom", "zoom", zoom,
                       {.low = static_cast<float>(kMinZoom),
                        .high = static_cast<float>(kMaxZoom),
                        .logarithmic = true,
                        .clamp = true},
                       quantity(state.workspace.zoom, "x")))
        state.workspace.zoom = static_cast<double>(zoom);
    ImGui::PopItemWidth();
    ImGui::Button("Clutch (hold C)");
    if (ImGui::IsItemActive())
        state.workspace.clutch = true;
    widgets.mark("clutch");
    widgets.beside(Widgets::buttonWidth("Centre"));
    if (widgets.button("centre", "Centre"))
        state.centrePressed = true;
    const std::string text = workspaceText(mapping);
    if (!text.empty())
        ImGui::TextColored(ImVec4(0.95f, 0.72f, 0.25f, 1.0f), "%s", text.c_str());
    const double scale = mapping.workspaceFromDevice.scale;
    if (scale > 1.0) {
        const DeviceLimits& limits = input.servo->last.sample.limits;
        widgets.wrapped("600 N/m feel like " + quantity(std::min(600.0 * scale, limits.maxStiffness), "N/m") +
                            "; the device bears " + quantity(limits.maxStiffness, "N/m"),
                        ImGui::GetColorU32(ImGuiCol_TextDisabled));
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
    widgets.beside(ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x +
                   ImGui::CalcTextSize("Simulated hand").x);
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
        widgets.check("freeHand", "free in space", state.view.freeHand);
        if (!state.view.freeHand)
            ImGui::TextDisabled("presses with %s", quantity(state.view.press, "N").c_str());
    }
    if (held || !input.devices.empty())
        devices(input, state, widgets);
    if (held || state.simulatedHand)
        workspace(input, state, widgets);
    if (!input.deviceStatus.empty())
        widgets.wrapped(input.deviceStatus);
}

} // namespace touchstone
