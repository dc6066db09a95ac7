#include "workbench/panels/timeline_curves.h"

#include "workbench/panels/scale.h"
#include "workbench/panels/timeline_panel.h"
#include "workbench/timeline/timeline_controller.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

constexpr ImU32 kCurveBackground = IM_COL32(22, 24, 27, 255), kCurveGrid = IM_COL32(48, 52, 58, 255),
                kCurveLabel = IM_COL32(140, 147, 155, 255), kCurveText = IM_COL32(228, 231, 234, 255),
                kCurveCursor = IM_COL32(235, 238, 240, 255), kForce = IM_COL32(245, 190, 70, 255),
                kAgain = IM_COL32(97, 173, 255, 255), kCompared = IM_COL32(105, 205, 135, 255),
                kContact = IM_COL32(245, 190, 70, 26), kLoop = IM_COL32(97, 173, 255, 34),
                kLoopEdge = IM_COL32(97, 173, 255, 200), kCurveGap = IM_COL32(235, 75, 65, 220),
                kScene = IM_COL32(120, 205, 130, 220), kSettings = IM_COL32(190, 150, 240, 230),
                kNote = IM_COL32(228, 231, 234, 220);

constexpr double kMinTop = 0.5;       // N, so that noise in the air does not fill the strip
constexpr float kLabelWidth = 108.0f; // units, the same as in the charts

ImU32 colorOf(TimelineMark::Kind kind) {
    switch (kind) {
    case TimelineMark::Kind::Gap:
        return kCurveGap;
    case TimelineMark::Kind::Scene:
        return kScene;
    case TimelineMark::Kind::Settings:
        return kSettings;
    case TimelineMark::Kind::Note:
        break;
    }
    return kNote;
}

/// An interval of the recording in a strip of the window.
class Strip {
  public:
    /// `near`: the scale follows the visible forces.
    Strip(TimelineController& controller, double begin, double end, bool near, float height, Widgets& widgets)
        : controller_(controller), line_(controller.timeline()), widgets_(widgets),
          draw_(*ImGui::GetWindowDrawList()), corner_(ImGui::GetCursorScreenPos()),
          left_(corner_.x + widgets.units(kLabelWidth)), right_(corner_.x + ImGui::GetContentRegionAvail().x),
          height_(height), begin_(begin), end_(std::max(end, begin + 1e-6)), near_(near) {}

    /// Curve, contact, marks and cursor; scrubs.
    void draw(const char* name) {
        draw_.AddRectFilled(ImVec2(left_, top()), ImVec2(right_, bottom()), kCurveBackground, 3.0f);
        draw_.PushClipRect(ImVec2(left_, top()), ImVec2(right_, bottom()), true);
        findScale();
        loop();
        curve();
        line(compared_, kCompared);
        line(again_, kAgain);
        marks();
        cursor();
        draw_.PopClipRect();
        char text[24];
        std::snprintf(text, sizeof text, "%g N", most_);
        draw_.AddText(ImVec2(left_ + widgets_.units(4.0f), top()), kCurveLabel, text);
        std::snprintf(text, sizeof text, "%g", least_);
        if (least_ > 0.0)
            draw_.AddText(ImVec2(left_ + widgets_.units(4.0f), bottom() - ImGui::GetTextLineHeight()),
                          kCurveLabel, text);
        scrub(name);
    }
    /// A line of the left column, from the top.
    void label(int row, ImU32 color, const char* text) const {
        draw_.AddText(ImVec2(corner_.x, top() + static_cast<float>(row) * ImGui::GetTextLineHeight()), color,
                      text);
    }
    void labelRight(int row, ImU32 color, const char* text) const {
        const float x = left_ - widgets_.units(8.0f) - ImGui::CalcTextSize(text).x;
        draw_.AddText(ImVec2(x, top() + static_cast<float>(row) * ImGui::GetTextLineHeight()), color, text);
    }

  private:
    using Columns = std::vector<std::optional<MinMax>>;

    [[nodiscard]] float top() const { return corner_.y; }
    [[nodiscard]] float bottom() const { return corner_.y + height_; }
    [[nodiscard]] float width() const { return std::max(2.0f, right_ - left_); }
    [[nodiscard]] double secondsAt(float x) const {
        return begin_ + (end_ - begin_) * static_cast<double>((x - left_) / width());
    }
    [[nodiscard]] float xOf(double seconds) const {
        return left_ + width() * static_cast<float>((seconds - begin_) / (end_ - begin_));
    }
    [[nodiscard]] float yOf(double newton) const {
        return bottom() - 1.0f -
               (height_ - 3.0f) *
                   static_cast<float>(std::clamp((newton - least_) / (most_ - least_), 0.0, 1.0));
    }
    [[nodiscard]] int columns() const { return static_cast<int>(width()); }

    /// The ticks of a pixel column; an empty range where there are none.
    [[nodiscard]] std::pair<size_t, size_t> ticksOf(int column) const {
        const auto from = [&](int c) {
            const double seconds = secondsAt(left_ + static_cast<float>(c));
            const size_t at = line_.indexAt(seconds);
            return line_.seconds(at) < seconds ? at + 1 : at;
        };
        return {from(column), from(column + 1)};
    }

    void findScale() {
        MinMax all = line_.force().over(line_.indexAt(begin_), line_.indexAt(end_) + 1);
        feltAgain();
        compared();
        for (const Columns* columns : {&again_, &compared_})
            for (const std::optional<MinMax>& column : *columns)
                if (column)
                    all = {std::min(all.least, column->least), std::max(all.most, column->most)};
        most_ = niceCeiling(std::max(kMinTop, static_cast<double>(all.most)));
        least_ = 0.0;
        // Forces that are never near zero: the scale shows their differences.
        constexpr double kSteps = 4.0;
        if (!near_ || static_cast<double>(all.least) < 0.3 * most_)
            return;
        const double step = niceCeiling(
            std::max(0.02, static_cast<double>(all.most) - static_cast<double>(all.least)) / kSteps);
        least_ = step * std::floor(static_cast<double>(all.least) / step);
        most_ = step * std::ceil(static_cast<double>(all.most) / step + 1e-6);
    }

    /// The replayed force by column. Not drawn in a strip with more ticks than this: the near view has it.
    void feltAgain() {
        constexpr size_t kMaxTicks = 200'000;
        const TouchAgain& again = controller_.again();
        again_.assign(static_cast<size_t>(columns()), std::nullopt);
        if (line_.indexAt(end_) - line_.indexAt(begin_) > kMaxTicks || again.force().empty())
            return;
        for (int c = 0; c < columns(); ++c) {
            const auto [from, to] = ticksOf(c);
            std::optional<MinMax>& column = again_[static_cast<size_t>(c)];
            const size_t end = std::min(to, again.first() + again.force().size());
            for (size_t i = std::max(from, again.first()); i < end; ++i) {
                const float newton = again.force()[i - again.first()];
                if (std::isnan(newton))
                    continue;
                if (!column)
                    column = MinMax{newton, newton};
                column->least = std::min(column->least, newton);
                column->most = std::max(column->most, newton);
            }
        }
    }

    /// The force with the settings of now, by column.
    void compared() {
        compared_.assign(static_cast<size_t>(columns()), std::nullopt);
        const ComparedTouch* const touch = controller_.comparison().result();
        for (int c = 0; touch != nullptr && c < columns(); ++c)
            if (const auto [from, to] = ticksOf(c); from < std::min(to, touch->force.size()))
                compared_[static_cast<size_t>(c)] =
                    touch->force.over(from, std::min(to, touch->force.size()));
    }

    void loop() {
        const Playback& at = controller_.playback();
        if (!at.beginMark() && !at.endMark())
            return;
        const float from = xOf(line_.seconds(at.first())), to = xOf(line_.seconds(at.last()));
        draw_.AddRectFilled(ImVec2(from, top()), ImVec2(to, bottom()), kLoop);
        for (const auto& [mark, x] : {std::pair(at.beginMark(), from), std::pair(at.endMark(), to)})
            if (mark)
                draw_.AddLine(ImVec2(x, top()), ImVec2(x, bottom()), kLoopEdge, 1.5f);
    }

    /// From the minimum to the maximum of each column: no peak is lost, however long the interval.
    void curve() {
        float before = yOf(least_);
        for (int c = 0; c < columns(); ++c) {
            const auto [first, last] = ticksOf(c);
            const float x = left_ + static_cast<float>(c);
            if (line_.touches(first, std::max(last, first + 1)) && first < line_.size())
                draw_.AddRectFilled(ImVec2(x, top()), ImVec2(x + 1.0f, bottom()), kContact);
            if (first >= last)
                continue;
            const MinMax force = line_.force().over(first, last);
            const float low = yOf(static_cast<double>(force.least)),
                        high = yOf(static_cast<double>(force.most));
            // Joined to the previous column, and at least one pixel high.
            draw_.AddRectFilled(ImVec2(x, std::min(high, before)),
                                ImVec2(x + 1.0f, std::max(low, before) + 1.0f), kForce);
            before = 0.5f * (low + high);
        }
    }

    /// A line through the middles, which joins columns without a tick.
    void line(const Columns& of, ImU32 color) {
        std::optional<ImVec2> before;
        constexpr float kFarthest = 40.0f; // pixels between two ticks of a near view
        for (int c = 0; c < columns(); ++c) {
            const std::optional<MinMax>& column = of[static_cast<size_t>(c)];
            if (!column)
                continue;
            const float x = left_ + static_cast<float>(c), low = yOf(static_cast<double>(column->least)),
                        high = yOf(static_cast<double>(column->most));
            const ImVec2 middle(x, 0.5f * (low + high));
            if (low - high > 1.5f)
                draw_.AddLine(ImVec2(x, low), ImVec2(x, high), color);
            if (before && x - before->x < kFarthest)
                draw_.AddLine(*before, middle, color, 1.5f);
            before = middle;
        }
    }

    /// At the tick where the mark takes effect; a gap from the last known tick.
    void marks() {
        const float flag = widgets_.units(4.0f);
        std::array<float, 4> last{-1e9f, -1e9f, -1e9f, -1e9f}; // of each kind
        for (const TimelineMark& mark : line_.marks()) {
            const double at = line_.seconds(std::min(mark.index, line_.size() - 1));
            const float x = xOf(at);
            float& before = last[static_cast<size_t>(mark.kind)];
            if (x < left_ - flag || x > right_ + flag || x - before < 1.0f)
                continue;
            before = x;
            const ImU32 color = colorOf(mark.kind);
            if (mark.kind == TimelineMark::Kind::Gap && mark.index > 0 && mark.index < line_.size()) {
                const float from = xOf(line_.seconds(mark.index - 1));
                draw_.AddRectFilled(ImVec2(from, top()), ImVec2(std::max(x, from + 1.0f), bottom()),
                                    IM_COL32(235, 75, 65, 70));
            }
            draw_.AddTriangleFilled(ImVec2(x - flag, top()), ImVec2(x + flag, top()),
                                    ImVec2(x, top() + 1.6f * flag), color);
            draw_.AddLine(ImVec2(x, top()), ImVec2(x, bottom()), (color & 0x00ffffff) | 0x60000000);
        }
    }

    void cursor() {
        const float x = xOf(controller_.playback().seconds());
        draw_.AddLine(ImVec2(x, top()), ImVec2(x, bottom()), kCurveCursor, 1.5f);
        const float grip = widgets_.units(4.0f);
        draw_.AddTriangleFilled(ImVec2(x - grip, bottom()), ImVec2(x, bottom() - 1.6f * grip),
                                ImVec2(x + grip, bottom()), kCurveCursor);
    }

    void scrub(const char* name) {
        ImGui::SetCursorScreenPos(ImVec2(left_, top()));
        ImGui::InvisibleButton(name, ImVec2(width(), height_));
        widgets_.mark(name);
        const float x = ImGui::GetIO().MousePos.x;
        if (Widgets::dragged()) {
            controller_.stopTouchingAgain();
            controller_.playback().play(false);
            controller_.playback().seek(secondsAt(std::clamp(x, left_, right_)));
        } else if (ImGui::IsItemHovered()) {
            tell(x);
        }
    }

    void tell(float x) const {
        const size_t at = line_.indexAt(secondsAt(x));
        ImGui::BeginTooltip();
        ImGui::Text("%.3f s   %.3f N", line_.seconds(at), static_cast<double>(line_.force()[at]));
        int told = 0;
        constexpr int kMaxTold = 6;
        for (const TimelineMark& mark : line_.marks()) {
            const float there = xOf(line_.seconds(std::min(mark.index, line_.size() - 1)));
            if (std::abs(there - x) > widgets_.units(5.0f) || ++told > kMaxTold)
                continue;
            ImGui::TextColored(ImColor(colorOf(mark.kind)), "%s", mark.text.c_str());
        }
        ImGui::EndTooltip();
    }

    TimelineController& controller_;
    const Timeline& line_;
    Widgets& widgets_;
    ImDrawList& draw_;
    ImVec2 corner_;
    float left_, right_, height_;
    double begin_, end_;
    Columns again_, compared_;
    bool near_;                       // the scale fits the visible range
    double least_ = 0.0, most_ = 1.0; // N, at its lower and its upper edge
};

} // namespace

void drawOverview(TimelineController& controller, float height, Widgets& widgets) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    Strip strip(controller, 0.0, controller.timeline().length(), false, height, widgets);
    strip.draw("timeline");
    char text[48];
    std::snprintf(text, sizeof text, "%.3f s", controller.playback().seconds());
    strip.label(0, kCurveText, text);
    std::snprintf(text, sizeof text, "of %.1f s", controller.timeline().length());
    strip.label(1, kCurveLabel, text);
    ImGui::SetCursorScreenPos(ImVec2(corner.x, corner.y + height));
}

void drawNear(TimelineController& controller, TimelinePanelState& state, float height, Widgets& widgets) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const Playback& at = controller.playback();
    const double length = controller.timeline().length();
    constexpr double kMinSpan = 0.02, kMaxSpan = 20.0; // s
    state.span = std::clamp(state.span, kMinSpan, kMaxSpan);
    // It stays until the cursor leaves it, so that the view does not scroll continuously.
    const double offset = (at.seconds() - state.nearBegin) / state.span;
    const bool dragged = ImGui::IsMouseDown(0) && offset >= 0.0 && offset <= 1.0;
    if (!dragged && (offset < 0.02 || offset > 0.98))
        state.nearBegin =
            at.seconds() - (at.playing() || controller.again().running() ? 0.1 : 0.5) * state.span;
    state.nearBegin = std::clamp(state.nearBegin, 0.0, std::max(0.0, length - state.span));
    Strip strip(controller, state.nearBegin, std::min(length, state.nearBegin + state.span), true, height,
                widgets);
    strip.draw("near");
    const float wheel = ImGui::GetIO().MouseWheel;
    if (ImGui::IsItemHovered() && wheel != 0.0f) {
        const double share = std::clamp(offset, 0.0, 1.0);
        state.span = std::clamp(state.span * std::pow(0.8, static_cast<double>(wheel)), kMinSpan, kMaxSpan);
        state.nearBegin = at.seconds() - share * state.span;
    }
    char text[48];
    std::snprintf(text, sizeof text, "%.3f N",
                  static_cast<double>(controller.timeline().force()[at.cursor()]));
    strip.label(0, kForce, "then");
    strip.labelRight(0, kForce, text);
    const TouchAgain& again = controller.again();
    const size_t cursor = at.cursor();
    int row = 1;
    const auto value = [&](const char* name, ImU32 color, float newton) {
        if (static_cast<float>(row + 1) * ImGui::GetTextLineHeight() >
            height + ImGui::GetStyle().ItemSpacing.y)
            return; // it would lie over the line below
        std::snprintf(text, sizeof text, "%.3f N", static_cast<double>(newton));
        strip.label(row, color, name);
        strip.labelRight(row++, color, text);
    };
    if (cursor >= again.first() && cursor - again.first() < again.force().size() &&
        !std::isnan(again.force()[cursor - again.first()]))
        value("again", kAgain, again.force()[cursor - again.first()]);
    if (const ComparedTouch* const compared = controller.comparison().result();
        compared != nullptr && cursor < compared->force.size())
        value("now", kCompared, compared->force[cursor]);
    ImGui::SetCursorScreenPos(ImVec2(corner.x, corner.y + height));
}

} // namespace touchstone
