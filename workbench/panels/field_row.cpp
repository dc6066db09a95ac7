#include "workbench/panels/field_row.h"

#include <imgui.h>

#include <string>

namespace touchstone {

namespace {

constexpr ImU32 kEdited = IM_COL32(240, 180, 60, 255), kStated = IM_COL32(215, 220, 226, 255),
                kUnset = IM_COL32(120, 126, 133, 255);
constexpr float kFieldColumn = 112.0f, kFieldGap = 4.0f; // units

} // namespace

void beginField(const Widgets& widgets, std::string_view name, const FieldState& state,
                std::string_view meaning) {
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, state.edited ? kEdited : state.stated ? kStated : kUnset);
    const std::string shown = shortened(name, widgets.units(kFieldColumn - kFieldGap));
    ImGui::TextUnformatted(shown.c_str());
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered())
        showNote(std::string(meaning) + (state.edited   ? "\nedited, not in the file yet"
                                         : state.stated ? "\nas the file states"
                                                        : "\nthe file states nothing"));
    ImGui::SameLine(widgets.units(kFieldColumn));
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x - Widgets::buttonWidth("x") -
                         widgets.units(kFieldGap));
}

bool endField(Widgets& widgets, std::string_view name, bool resettable) {
    ImGui::PopItemWidth();
    if (!resettable)
        return false;
    ImGui::SameLine(0.0f, widgets.units(kFieldGap));
    const std::string id(name);
    const bool pressed = ImGui::SmallButton(("x##" + id).c_str());
    widgets.mark(("reset." + id).c_str());
    return pressed;
}

} // namespace touchstone
