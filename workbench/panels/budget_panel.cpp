#include "workbench/panels/budget_panel.h"

#include "workbench/figures/quantity.h"
#include "workbench/panels/scale.h"

#include <imgui.h>

#include <algorithm>
#include <array>
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
constexpr ImU32 kTableLabel = IM_COL32(150, 157, 165, 255);
constexpr ImU32 kTableText = IM_COL32(228, 231, 234, 255);

double sum(const std::array<double, kStageCount>& stages) {
    return std::accumulate(stages.begin(), stages.end(), 0.0);
}

class Strips {
  public:
    Strips(const ServoView& servo, const Widgets& widgets)
        : servo_(servo), widgets_(widgets), draw_(*ImGui::GetWindowDrawList()),
          corner_(ImGui::GetCursorScreenPos()), width_(ImGui::GetContentRegionAvail().x),
          top_(niceCeiling(std::max(1.0, 1.02 * std::max(sum(servo.stageP50Us), sum(servo.stageP99Us))))) {}

    void draw() {
        const float line = ImGui::GetTextLineHeight(), bar = widgets_.units(15.0f);
        char text[96];
        if (sum(servo_.stageP99Us) <= 0.0)
            std::snprintf(text, sizeof text, "in contact: touch something");
        else
            std::snprintf(text, sizeof text, "median %.1f µs", servo_.contactP50Us);
        y_ = corner_.y;
        strip(text, servo_.stageP50Us, line, bar);
        std::snprintf(text, sizeof text, "99th percentile (p99) %.1f µs", servo_.contactP99Us);
        strip(text, servo_.stageP99Us, line, bar);
        ticks(line);
        whole(line);
        ImGui::Dummy(ImVec2(width_, y_ - corner_.y));
    }

  private:
    void strip(const char* title, const std::array<double, kStageCount>& stages, float line, float height) {
        draw_.AddText(ImVec2(corner_.x, y_), kTableLabel, title);
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
            const std::string text = figure(share * top_) + (share > 0.0 ? " µs" : "");
            const float width = ImGui::CalcTextSize(text.c_str()).x;
            const float x = at(share * top_) - static_cast<float>(share) * width;
            draw_.AddText(ImVec2(x, y_), kTableLabel, text.c_str());
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
                            ImVec2(corner_.x + std::max(1.0f, width_ * share), y_ + height), kTableText,
                            2.0f);
        y_ += height + widgets_.units(2.0f);
        char text[96];
        std::snprintf(text, sizeof text, "p99 is %.1f %% of the tick's ", 100.0 * static_cast<double>(share));
        draw_.AddText(ImVec2(corner_.x, y_), kTableLabel, (text + quantity(1e-6 * period, "s")).c_str());
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

/// Swatch and name of each stage, its median and its 99th percentile, under heads.
void drawLegend(const ServoView& servo, Widgets& widgets) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight(),
                side = widgets.units(9.0f), pitch = line + widgets.units(2.0f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const auto rightAt = [&](float part, float y, ImU32 color, const std::string& text) {
        draw.AddText(ImVec2(corner.x + part * width - ImGui::CalcTextSize(text.c_str()).x, y), color,
                     text.c_str());
    };
    constexpr float kMedian = 0.68f, kP99 = 1.0f; // right edges of the columns
    draw.AddText(corner, kTableLabel, "stage");
    rightAt(kMedian, corner.y, kTableLabel, "median, µs");
    rightAt(kP99, corner.y, kTableLabel, "p99, µs");
    for (size_t i = 0; i < kStageCount; ++i) {
        const ImVec2 at(corner.x, corner.y + static_cast<float>(i + 1) * pitch);
        const float low = 0.5f * (line - side);
        draw.AddRectFilled(ImVec2(at.x, at.y + low), ImVec2(at.x + side, at.y + low + side), kColors[i],
                           2.0f);
        draw.AddText(ImVec2(at.x + widgets.units(14.0f), at.y), kTableText, kStageNames[i].data());
        const auto tenths = [](double us) {
            char text[32];
            std::snprintf(text, sizeof text, "%.1f", us);
            return std::string(text);
        };
        rightAt(kMedian, at.y, kTableText, tenths(servo.stageP50Us[i]));
        rightAt(kP99, at.y, kTableText, tenths(servo.stageP99Us[i]));
    }
    ImGui::Dummy(ImVec2(width, static_cast<float>(kStageCount + 1) * pitch));
    widgets.mark("budgetLegend");
}

} // namespace

void drawBudget(const ServoView& servo, Widgets& widgets) {
    Strips(servo, widgets).draw();
    widgets.mark("budget");
    drawLegend(servo, widgets);
}

} // namespace touchstone
