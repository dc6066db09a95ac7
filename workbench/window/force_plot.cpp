#include "workbench/window/force_plot.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace touchstone {

namespace {

constexpr ImU32 kBackground = IM_COL32(22, 24, 27, 255);
constexpr ImU32 kGrid = IM_COL32(52, 56, 62, 255);
constexpr ImU32 kLabel = IM_COL32(140, 147, 155, 255);
constexpr ImU32 kForce = IM_COL32(245, 190, 70, 255);
constexpr ImU32 kTangential = IM_COL32(110, 185, 255, 255);

/// The next of 0.5, 1, 2, 5, 10 … that holds `most`.
float niceCeiling(float most) {
    float decade = 0.5f;
    for (const float factor : {1.0f, 2.0f, 4.0f, 10.0f, 20.0f})
        if (decade * factor >= most)
            return decade * factor;
    return std::ceil(most / 10.0f) * 10.0f;
}

} // namespace

void drawForcePlot(const ForceHistory& forces, float height) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(corner, end, kBackground, 4.0f);

    float most = 0.0f;
    for (size_t i = 0; i < forces.size(); ++i)
        most = std::max(most, forces.at(i).force);
    const float top = niceCeiling(most * 1.05f);
    const auto yOf = [&](float newton) {
        return end.y - 2.0f - (size.y - 4.0f) * std::min(newton / top, 1.0f);
    };
    for (const float share : {0.0f, 0.5f, 1.0f}) {
        const float y = yOf(share * top);
        draw.AddLine(ImVec2(corner.x, y), ImVec2(end.x, y), kGrid);
        char label[32];
        std::snprintf(label, sizeof label, "%g N", static_cast<double>(share * top));
        if (share > 0.0f)
            draw.AddText(ImVec2(corner.x + 4.0f, y + 1.0f), kLabel, label);
    }

    // One point a pixel column: the most of its ticks, so that no peak is lost.
    const auto columns = static_cast<size_t>(std::max(size.x, 2.0f));
    std::vector<ImVec2> force(columns), tangential(columns);
    for (size_t c = 0; c < columns; ++c) {
        const size_t from = c * forces.size() / columns;
        const size_t to = std::max(from + 1, (c + 1) * forces.size() / columns);
        float f = 0.0f, t = 0.0f;
        for (size_t i = from; i < std::min(to, forces.size()); ++i) {
            f = std::max(f, forces.at(i).force);
            t = std::max(t, forces.at(i).tangential);
        }
        const float x = corner.x + static_cast<float>(c);
        force[c] = ImVec2(x, yOf(f));
        tangential[c] = ImVec2(x, yOf(t));
    }
    draw.AddPolyline(force.data(), static_cast<int>(columns), kForce, 0, 1.5f);
    draw.AddPolyline(tangential.data(), static_cast<int>(columns), kTangential, 0, 1.5f);
    ImGui::Dummy(size);

    ImGui::TextColored(ImColor(kForce), "force");
    ImGui::SameLine();
    ImGui::TextColored(ImColor(kTangential), "along the surface");
    ImGui::SameLine();
    ImGui::TextDisabled("last 2 s");
}

} // namespace touchstone
