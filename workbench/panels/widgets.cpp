#include "workbench/panels/widgets.h"

#include <imgui.h>

namespace touchstone {

void Widgets::mark(const char* name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    rects_[name] = {low.x, low.y, high.x - low.x, high.y - low.y};
    if (ImGui::IsItemFocused())
        rects_["focused"] = rects_[name];
}

void Widgets::section(const char* title) const {
    ImGui::Dummy(ImVec2(0.0f, units(2.0f)));
    ImGui::TextDisabled("%s", title);
    ImGui::Separator();
}

bool Widgets::combo(const char* name, int& chosen, std::span<const char* const> labels) {
    ImGui::PushID(name);
    ImGui::PushItemWidth(-1.0f);
    const bool changed = ImGui::Combo("##combo", &chosen, labels.data(), static_cast<int>(labels.size()));
    mark(name);
    ImGui::PopItemWidth();
    ImGui::PopID();
    return changed;
}

bool Widgets::lampButton(const char* name, const char* label, bool on, unsigned color) {
    ImGui::PushID(name);
    const float line = ImGui::GetTextLineHeight(), radius = 0.28f * line;
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 text = ImGui::CalcTextSize(label);
    const float lamp = 2.0f * radius + units(7.0f);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (!on)
        ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(0, 0, 0, 0));
    const bool pressed = ImGui::Button(
        "##lamp", ImVec2(lamp + text.x + 2.0f * style.FramePadding.x, text.y + 2.0f * style.FramePadding.y));
    if (!on)
        ImGui::PopStyleColor();
    mark(name);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 middle(at.x + style.FramePadding.x + radius, at.y + style.FramePadding.y + 0.5f * text.y);
    if (on)
        draw.AddCircleFilled(middle, radius, color);
    else
        draw.AddCircle(middle, radius, ImGui::GetColorU32(ImGuiCol_TextDisabled), 0, 1.5f);
    draw.AddText(ImVec2(at.x + style.FramePadding.x + lamp, at.y + style.FramePadding.y),
                 ImGui::GetColorU32(on ? ImGuiCol_Text : ImGuiCol_TextDisabled), label);
    ImGui::PopID();
    return pressed;
}

} // namespace touchstone
