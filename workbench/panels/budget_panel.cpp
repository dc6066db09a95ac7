#include "workbench/panels/budget_panel.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>

namespace touchstone {

namespace {

/// One per stage; neighbours differ in hue and lightness, so that they remain distinct without colour.
constexpr std::array<ImU32, kStageCount> kColors{
    IM_COL32(126, 136, 150, 255), // sample
    IM_COL32(66, 135, 245, 255),  // contact
    IM_COL32(126, 200, 255, 255), // proxy
    IM_COL32(150, 110, 235, 255), // shading
    IM_COL32(240, 180, 70, 255),  // texture
    IM_COL32(225, 100, 85, 255),  // friction
    IM_COL32(120, 205, 130, 255), // force
    IM_COL32(215, 130, 190, 255)  // safety
};
constexpr ImU32 kEmpty = IM_COL32(38, 42, 47, 255);
constexpr ImU32 kLabel = IM_COL32(150, 157, 165, 255);
constexpr ImU32 kText = IM_COL32(228, 231, 234, 255);

/// The next of 1, 2, 5, 10 … µs not below `most`.
double niceCeiling(double most) {
    const double decade = std::pow(10.0, std::floor(std::log10(std::max(most, 1.0))));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= most)
            return factor * decade;
    return 10.0 * decade;
}

double sum(const std::array<double, kStageCount>& stages) {
    return std::accumulate(stages.begin(), stages.end(), 0.0);
}

class Strips {
  public:
    Strips(const ServoView& servo, const Widgets& widgets)
        : servo_(servo), widgets_(widgets), draw_(*ImGui::GetWindowDrawList()),
          corner_(ImGui::GetCursorScreenPos()), width_(ImGui::GetContentRegionAvail().x),
          top_(niceCeiling(1.02 * std::max(sum(servo.stageP50Us), sum(servo.stageP99Us)))) {}

    void draw() {
        const float line = ImGui::GetTextLineHeight(), bar = widgets_.units(15.0f);
        char text[96];
        if (sum(servo_.stageP99Us) <= 0.0)
            std::snprintf(text, sizeof text, "in contact: touch something");
        else
            std::snprintf(text, sizeof text, "half of all ticks within %.1f µs", servo_.contactP50Us);
        y_ = corner_.y;
        strip(text, servo_.stageP50Us, line, bar);
        std::snprintf(text, sizeof text, "99 of 100 within %.1f µs", servo_.contactP99Us);
        strip(text, servo_.stageP99Us, line, bar);
        ticks(line);
        whole(line);
        ImGui::Dummy(ImVec2(width_, y_ - corner_.y));
    }

  private:
    void strip(const char* title, const std::array<double, kStageCount>& stages, float line, float height) {
        draw_.AddText(ImVec2(corner_.x, y_), kLabel, title);
        y_ += line + widgets_.units(2.0f);
        draw_.AddRectFilled(ImVec2(corner_.x, y_), ImVec2(corner_.x + width_, y_ + height), kEmpty, 2.0f);
        double from = 0.0;
        for (size_t i = 0; i < kStageCount; ++i) {
            draw_.AddRectFilled(ImVec2(at(from), y_), ImVec2(at(from + stages[i]), y_ + height), kColors[i]);
            from += stages[i];
        }
        y_ += height + widgets_.units(3.0f);
    }

    /// The scale of both strips.
    void ticks(float line) {
        for (const double share : {0.0, 0.5, 1.0}) {
            char text[32];
            std::snprintf(text, sizeof text, share > 0.0 ? "%g µs" : "%g", share * top_);
            const float width = ImGui::CalcTextSize(text).x;
            const float x = at(share * top_) - static_cast<float>(share) * width;
            draw_.AddText(ImVec2(x, y_), kLabel, text);
        }
        y_ += line + widgets_.units(5.0f);
    }

    /// The servo's period, and the fraction that the 99th percentile takes.
    void whole(float line) {
        const double period = servo_.rateHz > 0.0 ? 1e6 / servo_.rateHz : 1000.0;
        const float height = widgets_.units(5.0f);
        draw_.AddRectFilled(ImVec2(corner_.x, y_), ImVec2(corner_.x + width_, y_ + height), kEmpty, 2.0f);
        const auto share = static_cast<float>(std::min(1.0, servo_.contactP99Us / period));
        draw_.AddRectFilled(ImVec2(corner_.x, y_),
                            ImVec2(corner_.x + std::max(1.0f, width_ * share), y_ + height), kText, 2.0f);
        y_ += height + widgets_.units(2.0f);
        char text[96];
        std::snprintf(text, sizeof text, "%.1f %% of the tick's %.0f µs", 100.0 * static_cast<double>(share),
                      period);
        draw_.AddText(ImVec2(corner_.x, y_), kLabel, text);
        y_ += line;
    }

    [[nodiscard]] float at(double us) const {
        return corner_.x + width_ * static_cast<float>(std::min(1.0, us / top_));
    }

    const ServoView& servo_;
    const Widgets& widgets_;
    ImDrawList& draw_;
    ImVec2 corner_;
    float width_;
    double top_; // µs at the strips' right end
    float y_ = 0.0f;
};

/// Swatch, name, p50 and p99 of each stage, in two columns.
void drawLegend(const ServoView& servo, Widgets& widgets) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float column = 0.5f * ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight(),
                side = widgets.units(9.0f), pitch = line + widgets.units(3.0f);
    constexpr size_t kRows = kStageCount / 2;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (size_t i = 0; i < kStageCount; ++i) {
        const ImVec2 at(corner.x + static_cast<float>(i / kRows) * column,
                        corner.y + static_cast<float>(i % kRows) * pitch);
        const float low = 0.5f * (line - side);
        draw.AddRectFilled(ImVec2(at.x, at.y + low), ImVec2(at.x + side, at.y + low + side), kColors[i],
                           2.0f);
        draw.AddText(ImVec2(at.x + widgets.units(14.0f), at.y), kText, kStageNames[i].data());
        char text[32];
        std::snprintf(text, sizeof text, "%.1f  %.1f", servo.stageP50Us[i], servo.stageP99Us[i]);
        draw.AddText(ImVec2(at.x + column - widgets.units(10.0f) - ImGui::CalcTextSize(text).x, at.y), kLabel,
                     text);
    }
    ImGui::Dummy(ImVec2(2.0f * column, static_cast<float>(kRows) * pitch));
    widgets.mark("budgetLegend");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("µs of each stage: median and 99th percentile of the last 4000 ticks in contact");
}

} // namespace

void drawBudget(const ServoView& servo, Widgets& widgets) {
    Strips(servo, widgets).draw();
    widgets.mark("budget");
    drawLegend(servo, widgets);
}

} // namespace touchstone
