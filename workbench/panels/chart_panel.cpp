#include "workbench/panels/colors.h"
#include "workbench/panels/notes.h"
#include "workbench/panels/panels.h"
#include "workbench/panels/scale.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

namespace {

using Entry = ForceHistory::Entry;

constexpr ImU32 kBackground = IM_COL32(22, 24, 27, 255), kGrid = IM_COL32(48, 52, 58, 255),
                kLabel = IM_COL32(140, 147, 155, 255), kCursor = IM_COL32(228, 231, 234, 160),
                kRecorded = IM_COL32(225, 75, 65, 255), kText = IM_COL32(228, 231, 234, 255),
                kGround = IM_COL32(22, 24, 27, 210); ///< of a label, over a curve

constexpr double kSpan = 10.0;      // s, of the axis
constexpr double kLongestGap = 0.1; // s without ticks that a curve bridges

ImU32 colorOf(const ChartQuantity& quantity) {
    return IM_COL32(quantity.color >> 16 & 0xff, quantity.color >> 8 & 0xff, quantity.color & 0xff, 255);
}
/// In the quantity's unit.
double valueOf(const ChartQuantity& quantity, const Entry& entry) {
    return static_cast<double>(entry.*quantity.value) / quantity.unit;
}

/// The values of the ticks under one column of pixels, in the order of time.
struct Column {
    double min = std::numeric_limits<double>::infinity(), max = -min, first = 0.0, last = 0.0;
    double time = 0.0; ///< s, of the last tick
    [[nodiscard]] bool empty() const { return min > max; }
    void add(double value, double at) {
        if (empty())
            first = value;
        min = std::min(min, value);
        max = std::max(max, value);
        last = value;
        time = at;
    }
};

class Charts {
  public:
    Charts(const ForceHistory& history, const ShownQuantities& shown, Widgets& widgets)
        : history_(history), shown_(shown), widgets_(widgets), draw_(*ImGui::GetWindowDrawList()),
          corner_(ImGui::GetCursorScreenPos()), size_(ImGui::GetContentRegionAvail()),
          left_(corner_.x + widgets.units(kLabelWidth)) {}

    void draw() {
        const auto strips = static_cast<float>(std::max<ptrdiff_t>(1, std::ranges::count(shown_, true)));
        const float axis = ImGui::GetTextLineHeight() + widgets_.units(5.0f), gap = widgets_.units(4.0f);
        const float height = std::max((size_.y - axis) / strips - gap, 8.0f);
        findCursor();
        float y = corner_.y;
        for (size_t i = 0; i < shown_.size(); ++i) {
            if (!shown_[i])
                continue;
            strip(chartQuantities()[i], y, height);
            y += height + gap;
        }
        timeAxis(y);
        if (cursor_) {
            const float x = xOf(history_.at(*cursor_).time);
            draw_.AddLine(ImVec2(x, corner_.y), ImVec2(x, y), kCursor);
        }
        ImGui::Dummy(size_);
        widgets_.mark("charts");
    }

  private:
    static constexpr float kLabelWidth = 132.0f; // units

    [[nodiscard]] float right() const { return corner_.x + size_.x; }
    [[nodiscard]] float width() const { return std::max(2.0f, right() - left_); }
    [[nodiscard]] double end() const {
        return history_.size() > 0 ? history_.at(history_.size() - 1).time : 0.0;
    }
    [[nodiscard]] double begin() const {
        return history_.size() > 0 ? std::min(history_.at(0).time, end() - kSpan) : end() - kSpan;
    }
    [[nodiscard]] float xOf(double time) const {
        return left_ + width() * static_cast<float>((time - begin()) / (end() - begin()));
    }

    /// The tick under the pointer, while it is over the charts: the first one that is not before it.
    void findCursor() {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (history_.size() == 0 || !ImGui::IsWindowHovered() || mouse.x < left_ || mouse.x > right() ||
            mouse.y < corner_.y || mouse.y > corner_.y + size_.y)
            return;
        const double time = begin() + static_cast<double>((mouse.x - left_) / width()) * (end() - begin());
        size_t low = 0, high = history_.size() - 1;
        while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if (history_.at(middle).time < time)
                low = middle + 1;
            else
                high = middle;
        }
        cursor_ = low;
    }

    /// From the least to the most of the ticks under each column of pixels, so that no peak is lost and a
    /// vibration is seen as a band.
    [[nodiscard]] std::vector<Column> columnsOf(const ChartQuantity& quantity) const {
        std::vector<Column> columns(static_cast<size_t>(width()));
        const double perSecond = static_cast<double>(columns.size()) / (end() - begin());
        for (size_t i = 0; i < history_.size(); ++i) {
            const Entry& entry = history_.at(i);
            const double at =
                std::clamp((entry.time - begin()) * perSecond, 0.0, static_cast<double>(columns.size() - 1));
            columns[static_cast<size_t>(at)].add(valueOf(quantity, entry), entry.time);
        }
        return columns;
    }

    void strip(const ChartQuantity& quantity, float y, float height) {
        draw_.AddRectFilled(ImVec2(left_, y), ImVec2(right(), y + height), kBackground, 3.0f);
        const std::vector<Column> columns = columnsOf(quantity);
        double most = quantity.minEnd;
        for (const Column& column : columns)
            if (!column.empty())
                most = std::max({most, std::abs(column.min), std::abs(column.max)});
        const double top = niceCeiling(most);
        const auto yOf = [&](double value) {
            const double share = quantity.positive ? value / top : 0.5 + 0.5 * value / top;
            return y + height - 1.5f - (height - 3.0f) * static_cast<float>(std::clamp(share, 0.0, 1.0));
        };
        for (const double time : ticksOfTime())
            draw_.AddLine(ImVec2(xOf(end() - time), y), ImVec2(xOf(end() - time), y + height), kGrid);
        draw_.AddLine(ImVec2(left_, yOf(0.0)), ImVec2(right(), yOf(0.0)), kGrid);
        const Column* before = nullptr;
        float beforeX = 0.0f;
        for (size_t c = 0; c < columns.size(); ++c) {
            const Column& column = columns[c];
            if (column.empty())
                continue;
            const float x = left_ + static_cast<float>(c);
            draw_.AddRectFilled(ImVec2(x, yOf(column.max) - 0.75f), ImVec2(x + 1.0f, yOf(column.min) + 0.75f),
                                colorOf(quantity));
            if (before != nullptr && column.time - before->time < kLongestGap)
                draw_.AddLine(ImVec2(beforeX + 0.5f, yOf(before->last)), ImVec2(x + 0.5f, yOf(column.first)),
                              colorOf(quantity), 1.5f);
            before = &column;
            beforeX = x;
        }
        label(quantity, y, height, top);
    }

    /// Name, and the value at the cursor, else the latest; ends of the scale where there is room.
    void label(const ChartQuantity& quantity, float y, float height, double top) {
        const float line = ImGui::GetTextLineHeight();
        const float middle = y + 0.5f * (height - line);
        draw_.AddText(ImVec2(corner_.x, middle), colorOf(quantity), quantity.name);
        const ImVec2 low(corner_.x, y), high(left_, y + height);
        if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(low, high))
            ImGui::SetTooltip("%s (%s)", quantity.explanation, quantity.symbol);
        if (history_.size() == 0)
            return;
        char text[48];
        std::snprintf(text, sizeof text, "%.2f %s",
                      valueOf(quantity, history_.at(cursor_.value_or(history_.size() - 1))), quantity.symbol);
        draw_.AddText(ImVec2(left_ - widgets_.units(8.0f) - ImGui::CalcTextSize(text).x, middle), kText,
                      text);
        std::snprintf(text, sizeof text, "%g %s", top, quantity.symbol);
        scaleLabel(text, y);
        if (height < 2.2f * line)
            return;
        std::snprintf(text, sizeof text, "%g", quantity.positive ? 0.0 : -top);
        scaleLabel(text, y + height - line);
        if (quantity.positive || height < 3.4f * line)
            return;
        scaleLabel("0", middle);
    }
    void scaleLabel(const char* text, float y) {
        const ImVec2 at(left_ + widgets_.units(4.0f), y), size = ImGui::CalcTextSize(text);
        draw_.AddRectFilled(ImVec2(at.x - 2.0f, at.y), ImVec2(at.x + size.x + 2.0f, at.y + size.y), kGround);
        draw_.AddText(at, kLabel, text);
    }

    /// Seconds before the latest tick at which the axis has a mark, without zero.
    [[nodiscard]] std::vector<double> ticksOfTime() const {
        const double length = end() - begin(), fitting = static_cast<double>(width() / widgets_.units(64.0f));
        const double step = niceCeiling(length / std::max(1.0, fitting));
        std::vector<double> times;
        for (double time = step; time < length * (1.0 + 1e-9); time += step)
            times.push_back(time);
        return times;
    }

    /// Seconds before the latest tick, and the recorded intervals.
    void timeAxis(float y) {
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
        const auto mark = [&](double time, const char* text) {
            const float wide = ImGui::CalcTextSize(text).x;
            const float x =
                std::clamp(xOf(end() - time) - 0.5f * wide, left_, std::max(left_, right() - wide));
            draw_.AddText(ImVec2(x, y + bar), kLabel, text);
        };
        draw_.AddText(ImVec2(corner_.x, y + bar), kLabel, "time");
        for (const double time : ticksOfTime()) {
            char text[32];
            std::snprintf(text, sizeof text, "-%g s", time);
            mark(time, text);
        }
        mark(0.0, "now");
    }

    const ForceHistory& history_;
    const ShownQuantities& shown_;
    Widgets& widgets_;
    ImDrawList& draw_;
    ImVec2 corner_, size_;
    float left_;
    std::optional<size_t> cursor_;
};

/// Which quantities have a strip; the last one stays.
void stripMenu(PanelState& state, Widgets& widgets) {
    widgets.besideArrow(Widgets::buttonWidth("Strips"));
    if (widgets.button("strips", "Strips"))
        ImGui::OpenPopup("strips");
    if (!ImGui::BeginPopup("strips"))
        return;
    for (size_t i = 0; i < kChartQuantityCount; ++i) {
        const ChartQuantity& quantity = chartQuantities()[i];
        bool shown = state.charts[i];
        if (ImGui::Checkbox(quantity.name, &shown) && (shown || std::ranges::count(state.charts, true) > 1))
            state.charts[i] = shown;
        widgets.mark((std::string("strip:") + quantity.name).c_str());
        ImGui::SameLine(widgets.units(110.0f));
        ImGui::TextDisabled("%s, %s", quantity.explanation, quantity.symbol);
    }
    ImGui::EndPopup();
}

/// Buttons that save, and what became of the last file.
void saveButtons(PanelState& state, Widgets& widgets) {
    struct Kind {
        const char *label, *name;
        ChartFile file;
    };
    widgets.besideArrow(ImGui::CalcTextSize("Save").x);
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Save");
    for (const Kind& kind :
         {Kind{"CSV", "saveCsv", ChartFile::Csv}, Kind{"PNG", "savePng", ChartFile::Picture},
          Kind{"SVG", "saveSvg", ChartFile::Figure}}) {
        widgets.besideArrow(Widgets::buttonWidth(kind.label));
        if (widgets.button(kind.name, kind.label))
            state.chartWanted = kind.file;
    }
}

/// The recording, or what became of the last file.
struct Outcome {
    std::string text, more; ///< `more`: as a tooltip
    ImU32 color = 0;
};

Outcome outcomeOf(const PanelInput& input) {
    constexpr double kShown = 20.0; // s, of a confirmation
    const ImU32 grey = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const SavedNote& saved = input.savedCharts;
    char text[64];
    std::snprintf(text, sizeof text, "%.1f s", input.recordedSeconds);
    if (input.chartsSaving)
        return {"drawing the figure", "", grey};
    if (!saved.text().empty() && input.now - saved.at < kShown)
        return saved.problem.empty()
                   ? Outcome{"saved " + saved.file.filename().string(), saved.file.string(), kGreen}
                   : Outcome{saved.problem.substr(0, saved.problem.find('\n')), saved.problem, kRed};
    if (input.recording)
        return {std::string("recording: ") + text, "", kRecorded};
    if (!input.recordingFile.empty())
        return {std::string("recorded ") + text + " in " +
                    std::filesystem::path(input.recordingFile).filename().string(),
                input.recordingFile, grey};
    return {};
}

/// Beside the buttons where it fits, else over the upper right corner of the charts: it comes and goes, and
/// must not move them.
void showOutcome(const Outcome& outcome, const ImVec2& beside, const ImVec2& charts, Widgets& widgets) {
    if (outcome.text.empty())
        return;
    const ImVec2 size = ImGui::CalcTextSize(outcome.text.c_str());
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const bool fits = beside.x + size.x + ImGui::GetFrameHeight() + widgets.units(8.0f) < right;
    const ImVec2 at =
        fits ? beside : ImVec2(std::max(charts.x, right - size.x - widgets.units(4.0f)), charts.y);
    const ImVec2 end(at.x + size.x, at.y + size.y);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (!fits)
        draw.AddRectFilled(ImVec2(at.x - widgets.units(4.0f), at.y),
                           ImVec2(end.x + widgets.units(4.0f), end.y), kGround);
    draw.AddText(at, outcome.color, outcome.text.c_str());
    widgets.place("chartOutcome",
                  {at.x, at.y, size.x, size.y, outcome.more.empty() ? noteOf("chartOutcome") : outcome.more});
    if (!outcome.more.empty() && ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(at, end))
        ImGui::SetTooltip("%s", outcome.more.c_str());
}

} // namespace

void drawCharts(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const bool paused = state.stopped.has_value();
    widgets.besideArrow(widgets.lampWidth("Pause"));
    // One label: a button that grew would push the others from under the pointer.
    if (widgets.lampButton("pause", "Pause", paused, kAmber))
        state.stopped = paused ? std::nullopt : std::optional(*input.forces);
    stripMenu(state, widgets);
    saveButtons(state, widgets);
    const ImVec2 button = ImGui::GetItemRectMin();
    const ImVec2 beside(ImGui::GetItemRectMax().x + widgets.units(10.0f),
                        button.y + ImGui::GetStyle().FramePadding.y);
    const ImVec2 charts = ImGui::GetCursorScreenPos();
    Charts(state.stopped ? *state.stopped : *input.forces, state.charts, widgets).draw();
    showOutcome(outcomeOf(input), beside, charts, widgets);
}

} // namespace touchstone
