#include "workbench/panels/pad_view.h"

#include "haptics/finger/finger_pad.h"

#include <imgui.h>

#include <algorithm>

namespace touchstone {

WidgetRect drawPadView(const glm::dvec2& location, const WidgetRect& picture, float scale) {
    constexpr double kPixelsPerMetre = 5500.0; // at scale 1: the pad is 88 pixels wide
    constexpr ImU32 kSkin = IM_COL32(226, 176, 140, 60), kRim = IM_COL32(226, 176, 140, 255),
                    kDot = IM_COL32(97, 173, 255, 255), kCross = IM_COL32(226, 176, 140, 90);
    const FingerPad pad;
    const auto unit = static_cast<float>(kPixelsPerMetre) * scale;
    const float radius = static_cast<float>(pad.reach) * unit, room = 2.0f * (radius + 12.0f * scale);
    const float margin = 14.0f * scale;
    const ImVec2 corner(picture.x + picture.width - room - margin,
                        picture.y + picture.height - room - margin);
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize(ImVec2(room, room));
    ImGui::SetNextWindowBgAlpha(0.75f);
    ImGui::Begin("pad", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 middle(corner.x + 0.5f * room, corner.y + 0.5f * room);
    list.AddCircleFilled(middle, radius, kSkin, 48);
    list.AddCircle(middle, radius, kRim, 48, 1.5f * scale);
    list.AddLine(ImVec2(middle.x - radius, middle.y), ImVec2(middle.x + radius, middle.y), kCross);
    list.AddLine(ImVec2(middle.x, middle.y - radius), ImVec2(middle.x, middle.y + radius), kCross);
    // Along the finger to the right, across downwards, as x and z of a device that is seen from above.
    list.AddCircleFilled(ImVec2(middle.x + static_cast<float>(location.x) * unit,
                                middle.y + static_cast<float>(location.y) * unit),
                         5.0f * scale, kDot, 20);
    ImGui::End();
    return {corner.x, corner.y, room, room};
}

} // namespace touchstone
