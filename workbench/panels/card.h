#pragma once

#include "workbench/panels/widgets.h"

#include <imgui.h>

namespace touchstone {

/// Windows over the picture: sized to their content, at a given position.
inline constexpr ImGuiWindowFlags kCardFlags =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoFocusOnAppearing;

/// A card that waits for an answer: it takes the keyboard and comes to the front, once.
inline constexpr ImGuiWindowFlags kAnsweredCard = kCardFlags & ~ImGuiWindowFlags_NoFocusOnAppearing;

/// Begins a card, with a border that separates it from what is beneath. ImGui::End follows whatever it
/// returns. `flags`: kCardFlags, or kAnsweredCard for a card on top of everything.
inline bool beginCardWindow(const char* name, const Widgets& widgets, ImGuiWindowFlags flags = kCardFlags) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, widgets.units(6.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
    ImGui::PushStyleColor(ImGuiCol_Border, ImVec4(0.34f, 0.37f, 0.41f, 1.0f));
    const bool open = ImGui::Begin(name, nullptr, flags);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
    return open;
}

} // namespace touchstone
