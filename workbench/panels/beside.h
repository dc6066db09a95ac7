#pragma once

#include <imgui.h>

namespace touchstone {

/// The next widget, `width` wide, stands on the same line where it fits.
inline void beside(float width) {
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    ImGui::SameLine();
    // The arrow that folds the panel is the last item of the first line.
    if (ImGui::GetContentRegionAvail().x < width + spacing + ImGui::GetFrameHeight())
        ImGui::NewLine();
}

/// Width of a button with this label.
inline float buttonWidth(const char* label) {
    return ImGui::CalcTextSize(label, nullptr, true).x + 2.0f * ImGui::GetStyle().FramePadding.x;
}

} // namespace touchstone
