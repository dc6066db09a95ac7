#include "workbench/figures/time_histogram.h"

#include "workbench/figures/tick_statistics.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

constexpr ImU32 kBar = IM_COL32(110, 185, 255, 255);
constexpr ImU32 kLate = IM_COL32(240, 110, 90, 255); // a period at 1 kHz or more
constexpr ImU32 kLabel = IM_COL32(140, 147, 155, 255);

/// Label of the end of bin `i`: 500, 1ms, and > for the last.
std::string endOf(size_t i) {
    if (i >= kHistogramEndsUs.size())
        return ">";
    const int64_t us = kHistogramEndsUs[i];
    return us < 1000 ? std::to_string(us) : std::to_string(us / 1000) + "ms";
}

} // namespace

void showTimeHistogram(const char* title, const char* note, const std::vector<uint64_t>& bins, float scale) {
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(title);
    const float width = 30.0f * scale, height = 90.0f * scale, line = ImGui::GetTextLineHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    uint64_t most = 1;
    for (const uint64_t count : bins)
        most = std::max(most, count);
    const double top = std::log10(static_cast<double>(most)) + 1.0; // one tick has a visible bar
    for (size_t i = 0; i < bins.size(); ++i) {
        const float x = corner.x + static_cast<float>(i) * width, base = corner.y + height;
        if (bins[i] > 0) {
            const double share = (std::log10(static_cast<double>(bins[i])) + 1.0) / top;
            const bool late = i >= kHistogramEndsUs.size() || kHistogramEndsUs[i] > 1000;
            draw.AddRectFilled(ImVec2(x + 1.0f, base - height * static_cast<float>(share)),
                               ImVec2(x + width - 1.0f, base), late ? kLate : kBar, 2.0f);
        }
        const std::string end = endOf(i);
        const float inset = 0.5f * (width - ImGui::CalcTextSize(end.c_str()).x);
        draw.AddText(ImVec2(x + inset, base + 2.0f), kLabel, end.c_str());
    }
    ImGui::Dummy(ImVec2(width * static_cast<float>(bins.size()) + 8.0f * scale, height + line + 4.0f));
    ImGui::TextDisabled("%s", note);
    ImGui::EndTooltip();
}

} // namespace touchstone
