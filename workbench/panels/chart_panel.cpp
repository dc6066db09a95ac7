#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"
#include "workbench/panels/scale.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace touchstone {

namespace {

using Entry = ForceHistory::Entry;

constexpr ImU32 kBackground = IM_COL32(22, 24, 27, 255), kGrid = IM_COL32(48, 52, 58, 255),
                kLabel = IM_COL32(140, 147, 155, 255), kCursor = IM_COL32(228, 231, 234, 160),
                kRecorded = IM_COL32(225, 75, 65, 255), kText = IM_COL32(228, 231, 234, 255),
                kGround = IM_COL32(22, 24, 27, 210); ///< of a label, over a curve

struct Chart {
    const char *name, *unit;
    ImU32 color;
    double (*value)(const Entry&);
    double least;  ///< minimum end of the scale
    bool fromZero; ///< otherwise symmetric about zero
};
constexpr std::array<Chart, 4> kCharts{{
    {"force", "N", IM_COL32(245, 190, 70, 255), [](const Entry& e) { return static_cast<double>(e.force); },
     0.5, true},
    {"depth", "mm", IM_COL32(110, 185, 255, 255),
     [](const Entry& e) { return 1e3 * static_cast<double>(e.penetration); }, 0.5, true},
    {"energy", "mJ", IM_COL32(120, 205, 130, 255),
     [](const Entry& e) { return 1e3 * static_cast<double>(e.energy); }, 0.1, false},
    {"step", "µs", IM_COL32(190, 150, 240, 255),
     [](const Entry& e) { return 1e6 * static_cast<double>(e.step); }, 10.0, true},
}};

class Charts {
  public:
    Charts(const ForceHistory& history, Widgets& widgets)
        : history_(history), widgets_(widgets), draw_(*ImGui::GetWindowDrawList()),
          corner_(ImGui::GetCursorScreenPos()), size_(ImGui::GetContentRegionAvail()),
          left_(corner_.x + widgets.units(108.0f)) {}

    void draw() {
        const float timeline = widgets_.units(18.0f), gap = widgets_.units(4.0f);
        const float row = (size_.y - timeline) / static_cast<float>(kCharts.size()) - gap;
        findCursor();
        float y = corner_.y;
        for (const Chart& chart : kCharts) {
            one(chart, y, std::max(row, 8.0f));
            y += std::max(row, 8.0f) + gap;
        }
        times(y);
        if (cursor_ < history_.size()) {
            const float x = xOf(history_.at(cursor_).time);
            draw_.AddLine(ImVec2(x, corner_.y), ImVec2(x, y), kCursor);
        }
        ImGui::Dummy(size_);
        widgets_.mark("charts");
    }

  private:
    [[nodiscard]] float right() const { return corner_.x + size_.x; }
    [[nodiscard]] float width() const { return std::max(2.0f, right() - left_); }
    [[nodiscard]] double begin() const { return history_.size() > 0 ? history_.at(0).time : 0.0; }
    [[nodiscard]] double end() const {
        return history_.size() > 0 ? history_.at(history_.size() - 1).time : 1.0;
    }
    [[nodiscard]] float xOf(double time) const {
        const double length = std::max(1e-9, end() - begin());
        return left_ + width() * static_cast<float>((time - begin()) / length);
    }

    /// The tick under the pointer, while it is over the charts.
    void findCursor() {
        cursor_ = std::numeric_limits<size_t>::max();
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (history_.size() == 0 || !ImGui::IsWindowHovered() || mouse.x < left_ || mouse.x > right() ||
            mouse.y < corner_.y || mouse.y > corner_.y + size_.y)
            return;
        const auto share = static_cast<double>((mouse.x - left_) / width());
        cursor_ = std::min(history_.size() - 1,
                           static_cast<size_t>(share * static_cast<double>(history_.size() - 1) + 0.5));
    }

    /// One point per pixel column: the maximum of its ticks, so that no peak is lost; of a signed quantity
    /// the one farthest from zero.
    void one(const Chart& chart, float y, float height) {
        draw_.AddRectFilled(ImVec2(left_, y), ImVec2(right(), y + height), kBackground, 3.0f);
        const auto columns = static_cast<size_t>(width());
        std::vector<double> values(columns, 0.0);
        double most = chart.least;
        for (size_t i = 0; i < history_.size(); ++i) {
            const double value = chart.value(history_.at(i));
            double& column = values[std::min(columns - 1, i * columns / history_.size())];
            if (std::abs(value) > std::abs(column))
                column = value;
            most = std::max(most, std::abs(value));
        }
        const double top = niceCeiling(most);
        const auto yOf = [&](double value) {
            const double share = chart.fromZero ? value / top : 0.5 + 0.5 * value / top;
            return y + height - 1.0f - (height - 2.0f) * static_cast<float>(std::clamp(share, 0.0, 1.0));
        };
        draw_.AddLine(ImVec2(left_, yOf(0.0)), ImVec2(right(), yOf(0.0)), kGrid);
        std::vector<ImVec2> line(columns);
        for (size_t c = 0; c < columns; ++c)
            line[c] = ImVec2(left_ + static_cast<float>(c), yOf(values[c]));
        if (history_.size() > 1)
            draw_.AddPolyline(line.data(), static_cast<int>(columns), chart.color, 0, 1.5f);
        label(chart, y, height, top);
    }

    /// Name, and the value at the cursor, else the latest; end of the scale.
    void label(const Chart& chart, float y, float height, double top) {
        const float line = ImGui::GetTextLineHeight(), middle = y + 0.5f * (height - line);
        draw_.AddText(ImVec2(corner_.x, middle), chart.color, chart.name);
        if (history_.size() == 0)
            return;
        char text[48];
        const size_t shown = std::min(cursor_, history_.size() - 1);
        std::snprintf(text, sizeof text, "%.2f %s", chart.value(history_.at(shown)), chart.unit);
        draw_.AddText(ImVec2(left_ - widgets_.units(8.0f) - ImGui::CalcTextSize(text).x, middle), kText,
                      text);
        std::snprintf(text, sizeof text, chart.fromZero ? "%g" : "±%g", top);
        const ImVec2 at(left_ + widgets_.units(4.0f), y), size = ImGui::CalcTextSize(text);
        draw_.AddRectFilled(ImVec2(at.x - 2.0f, at.y), ImVec2(at.x + size.x + 2.0f, at.y + size.y), kGround);
        draw_.AddText(at, kLabel, text);
    }

    /// Seconds before the latest tick, and the recorded intervals.
    void times(float y) {
        const float bar = widgets_.units(3.0f);
        draw_.AddRectFilled(ImVec2(left_, y), ImVec2(right(), y + bar), kGrid, 1.0f);
        for (size_t i = 0; i < history_.size();) {
            size_t last = i;
            while (last + 1 < history_.size() && history_.at(last + 1).recorded == history_.at(i).recorded)
                ++last;
            if (history_.at(i).recorded)
                draw_.AddRectFilled(ImVec2(xOf(history_.at(i).time), y),
                                    ImVec2(xOf(history_.at(last).time) + 1.0f, y + bar), kRecorded, 1.0f);
            i = last + 1;
        }
        const double length = end() - begin();
        for (const double share : {0.0, 0.5, 1.0}) {
            char text[32];
            std::snprintf(text, sizeof text, share < 1.0 ? "-%.1f s" : "now", (1.0 - share) * length);
            const float x = left_ + static_cast<float>(share) * (width() - ImGui::CalcTextSize(text).x);
            draw_.AddText(ImVec2(x, y + bar), kLabel, text);
        }
    }

    const ForceHistory& history_;
    Widgets& widgets_;
    ImDrawList& draw_;
    ImVec2 corner_, size_;
    float left_;
    size_t cursor_ = std::numeric_limits<size_t>::max();
};

} // namespace

void drawCharts(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const bool paused = state.stopped.has_value();
    const float fold = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x; // of the panel's arrow
    widgets.beside(widgets.lampWidth("Paused"), fold);
    if (widgets.lampButton("pause", paused ? "Paused" : "Pause", paused, kAmber))
        state.stopped = paused ? std::nullopt : std::optional(*input.forces);
    widgets.beside(Widgets::buttonWidth("Save CSV"), fold);
    if (widgets.button("saveCsv", "Save CSV"))
        state.chartWanted = ChartFile::Csv;
    widgets.beside(Widgets::buttonWidth("Save PNG"), fold);
    if (widgets.button("savePng", "Save PNG"))
        state.chartWanted = ChartFile::Picture;
    char text[256] = "";
    if (input.recording)
        std::snprintf(text, sizeof text, "recording: %.1f s", input.recordedSeconds);
    else if (!input.recordingFile.empty())
        std::snprintf(text, sizeof text, "recorded %.1f s in %s", input.recordedSeconds,
                      std::filesystem::path(input.recordingFile).filename().c_str());
    if (*text != '\0') {
        widgets.beside(ImGui::CalcTextSize(text).x, fold);
        ImGui::AlignTextToFramePadding();
        ImGui::TextColored(input.recording ? ImColor(kRecorded)
                                           : ImColor(ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled)),
                           "%s", text);
    }
    Charts(state.stopped ? *state.stopped : *input.forces, widgets).draw();
}

} // namespace touchstone
