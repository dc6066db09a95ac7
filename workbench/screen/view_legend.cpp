#include "workbench/screen/view_legend.h"

#include "workbench/figures/quantity.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

constexpr float kWidth = 220.0f, kBar = 12.0f, kPadding = 9.0f; // units of layout

ImU32 colorOf(const glm::vec3& c) {
    return ImGui::GetColorU32(ImVec4(c.x, c.y, c.z, 1.0f));
}

/// One line: a colour swatch and its meaning.
struct Entry {
    glm::vec3 color;
    std::string text;
};

std::vector<Entry> entriesOf(const ViewLegend& legend) {
    std::vector<Entry> entries;
    for (const EffectColors::Kind& kind : legend.kinds)
        entries.push_back({kind.color, kind.effects});
    if (legend.mode == ViewMode::Normals)
        entries = {{{1.0f, 0.5f, 0.5f}, "+x  right"},
                   {{0.5f, 1.0f, 0.5f}, "+y  up"},
                   {{0.5f, 0.5f, 1.0f}, "+z  to the user"}};
    if (legend.mode == ViewMode::Uv)
        entries = {{{0.9f, 0.1f, 0.25f}, "U grows with red"},
                   {{0.1f, 0.9f, 0.25f}, "V grows with green; 10 cells to 1"}};
    return entries;
}

void drawBar(ImDrawList& draw, const FalseColorScale& scale, ImVec2 at, float width, float height) {
    constexpr int kSteps = 48;
    for (int i = 0; i < kSteps; ++i) {
        const float x = at.x + width * static_cast<float>(i) / kSteps;
        draw.AddRectFilled(ImVec2(x, at.y),
                           ImVec2(at.x + width * static_cast<float>(i + 1) / kSteps, at.y + height),
                           colorOf(falseColor((i + 0.5) / kSteps)));
    }
    // Labels at both ends and in the middle, all in one unit.
    const ShownUnit unit = shownUnit(std::max(std::abs(scale.low), std::abs(scale.high)), scale.unit);
    for (const double t : {0.0, 0.5, 1.0}) {
        const std::string text = quantity(scale.low + t * (scale.high - scale.low), unit);
        const float textWidth = ImGui::CalcTextSize(text.c_str()).x, x = at.x + width * static_cast<float>(t);
        draw.AddLine(ImVec2(x, at.y + height), ImVec2(x, at.y + 1.35f * height),
                     IM_COL32(220, 224, 228, 255));
        draw.AddText(ImVec2(x - textWidth * static_cast<float>(t), at.y + 1.4f * height),
                     IM_COL32(220, 224, 228, 255), text.c_str());
    }
}

} // namespace

const char* viewTitle(ViewMode mode) {
    constexpr std::array kTitles{"as it looks",
                                 "height",
                                 "static friction coefficient",
                                 "stiffness",
                                 "damping",
                                 "normals",
                                 "texture coordinates",
                                 "tilt of the felt normal against the facet",
                                 "largest angle between facets at a vertex",
                                 "effects that the plan switches on",
                                 "edges that people may feel [004]"};
    static_assert(kTitles.size() == kViewModeNames.size());
    return kTitles[static_cast<size_t>(mode)];
}

void drawViewLegend(const ViewLegend& legend, const glm::vec2& corner, float scale) {
    if (legend.mode == ViewMode::Shaded)
        return;
    const std::vector<Entry> entries = entriesOf(legend);
    const bool unstated = entries.empty() && !legend.scale.meaningful;
    const float line = ImGui::GetTextLineHeightWithSpacing(), pad = kPadding * scale, bar = kBar * scale;
    float width = std::max(kWidth * scale, ImGui::CalcTextSize(viewTitle(legend.mode)).x);
    for (const Entry& entry : entries)
        width = std::max(width, 1.5f * line + ImGui::CalcTextSize(entry.text.c_str()).x);
    const float body =
        entries.empty() ? (unstated ? line : 1.4f * bar + line) : line * static_cast<float>(entries.size());
    const ImVec2 low(corner.x, corner.y - body - line - 2.0f * pad),
        high(corner.x + width + 2.0f * pad, corner.y);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled(low, high, IM_COL32(18, 20, 23, 200), 5.0f * scale);
    ImVec2 at(low.x + pad, low.y + pad);
    draw.AddText(at, IM_COL32(240, 242, 245, 255), viewTitle(legend.mode));
    at.y += line;
    for (const Entry& entry : entries) {
        draw.AddRectFilled(at, ImVec2(at.x + line, at.y + 0.75f * line), colorOf(entry.color), 2.0f * scale);
        draw.AddText(ImVec2(at.x + 1.5f * line, at.y), IM_COL32(220, 224, 228, 255), entry.text.c_str());
        at.y += line;
    }
    if (unstated)
        draw.AddText(at, IM_COL32(170, 175, 180, 255), "no material states it: grey");
    else if (entries.empty())
        drawBar(draw, legend.scale, at, width, bar);
}

} // namespace touchstone
