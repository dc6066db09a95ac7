#pragma once

#include "workbench/panels/widgets.h"

#include <imgui.h>

namespace touchstone {

/// Of what lies over the picture: as large as what it says, where it is put.
inline constexpr ImGuiWindowFlags kCardFlags =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoFocusOnAppearing;

/// Of a card that waits for an answer: it takes the keyboard and comes before the others, once.
inline constexpr ImGuiWindowFlags kAnsweredCard = kCardFlags & ~ImGuiWindowFlags_NoFocusOnAppearing;

/// Begins one, with an edge that tells it from what is beneath. ImGui::End follows whatever it returns.
/// `flags`: kCardFlags, or kAnsweredCard for what is to lie over everything when it comes.
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
