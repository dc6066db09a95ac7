#include "workbench/panels/widgets.h"

#include "workbench/panels/notes.h"

#include <imgui.h>
#include <imgui_internal.h> // TempInputIsActive

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kRest = 0.5; // s that the pointer rests before a tooltip appears

float widthOf(std::string_view text) {
    return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
}

/// The bytes of the first character of a UTF-8 text.
size_t firstCharacter(std::string_view text) {
    size_t bytes = 1;
    while (bytes < text.size() && (static_cast<unsigned char>(text[bytes]) & 0xC0u) == 0x80u)
        ++bytes;
    return bytes;
}

/// The bytes of `word` that fit into `width`, one character at least.
size_t fitting(std::string_view word, float width) {
    size_t bytes = firstCharacter(word);
    while (bytes < word.size()) {
        const size_t next = bytes + firstCharacter(word.substr(bytes));
        if (widthOf(word.substr(0, next)) > width)
            break;
        bytes = next;
    }
    return bytes;
}

/// Fraction of the slider's way, as ImGui has it.
float fractionOf(float value, const SliderRange& range) {
    if (range.logarithmic && range.low > 0.0f)
        return std::clamp(std::log(std::max(value, range.low) / range.low) / std::log(range.high / range.low),
                          0.0f, 1.0f);
    return std::clamp((value - range.low) / (range.high - range.low), 0.0f, 1.0f);
}

/// As many digits as a value needs to be set within a thousandth of the range: ImGui rounds to what it shows.
std::string formatFor(const SliderRange& range) {
    constexpr int kDigits = 4, kMostDigits = 9; // which tell a float from the next
    const float largest = std::max(std::abs(range.low), std::abs(range.high));
    const float more = std::ceil(std::log10(largest / (range.high - range.low)));
    return "%." +
           std::to_string(
               std::clamp(kDigits + static_cast<int>(std::max(more, 0.0f)), kDigits, kMostDigits)) +
           "g";
}

} // namespace

std::string brokenLines(std::string_view text, float width) {
    std::string lines;
    size_t begin = 0; // of the line, in `lines`
    const auto breakLine = [&] {
        lines += '\n';
        begin = lines.size();
    };
    while (!text.empty()) {
        const size_t end = std::min(text.find_first_of(" \n"), text.size());
        std::string_view word = text.substr(0, end);
        const bool first = lines.size() == begin;
        const std::string longer =
            lines.substr(begin) + (first ? "" : " ") + std::string(word); // the line with this word
        if (widthOf(longer) <= width) {
            lines.replace(begin, std::string::npos, longer);
        } else {
            if (!first)
                breakLine();
            while (widthOf(word) > width && word.size() > 1) {
                const size_t bytes = fitting(word, width);
                lines += word.substr(0, bytes);
                word.remove_prefix(bytes);
                if (!word.empty())
                    breakLine();
            }
            lines += word;
        }
        if (end < text.size() && text[end] == '\n')
            breakLine();
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

std::string shortened(std::string_view text, float width) {
    if (widthOf(text) <= width)
        return std::string(text);
    constexpr std::string_view kMore = "…";
    return std::string(text.substr(0, fitting(text, std::max(0.0f, width - widthOf(kMore))))) +
           std::string(kMore);
}

void showNote(std::string_view text) {
    if (text.empty())
        return;
    const std::string lines = brokenLines(text, 24.0f * ImGui::GetFontSize());
    ImGui::SetTooltip("%s", lines.c_str());
}

void Widgets::mark(const char* name, std::string_view note) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    WidgetRect& rect = rects_[name];
    rect = {low.x, low.y, high.x - low.x, high.y - low.y, note.empty() ? noteOf(name) : std::string(note)};
    if (hovered_ != nullptr && !isArea(name) && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        hover(name, rect.note);
    if (ImGui::IsItemFocused())
        rects_["focused"] = rect;
}

void Widgets::hover(const char* name, const std::string& note) {
    const double now = ImGui::GetTime();
    const int frame = ImGui::GetFrameCount();
    // A click puts the tooltip away until the pointer has rested again.
    const bool still = hovered_->name == name && hovered_->frame + 1 >= frame && !ImGui::IsMouseDown(0);
    if (!still)
        hovered_->since = now;
    hovered_->name = name;
    hovered_->frame = frame;
    hovered_->shown = now - hovered_->since >= kRest ? note : "";
    showNote(hovered_->shown);
}

void Widgets::section(const char* title) const {
    ImGui::Dummy(ImVec2(0.0f, units(2.0f)));
    ImGui::TextDisabled("%s", title);
    ImGui::Separator();
}

void Widgets::beside(float width, float end) const {
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < width + end)
        ImGui::NewLine();
}

void Widgets::wrapped(std::string_view text, unsigned color) const {
    const std::string lines = brokenLines(text, ImGui::GetContentRegionAvail().x);
    ImGui::PushStyleColor(ImGuiCol_Text, color != 0 ? color : ImGui::GetColorU32(ImGuiCol_Text));
    ImGui::TextUnformatted(lines.c_str());
    ImGui::PopStyleColor();
}

void Widgets::besideArrow(float width) const {
    beside(width, ImGui::GetStyle().ItemSpacing.x + ImGui::GetFrameHeight());
}

bool Widgets::dragged() {
    const ImVec2 way = ImGui::GetIO().MouseDelta;
    return ImGui::IsItemActive() || (ImGui::IsItemDeactivated() && (way.x != 0.0f || way.y != 0.0f));
}

float Widgets::buttonWidth(const char* label) {
    return ImGui::CalcTextSize(label, nullptr, true).x + 2.0f * ImGui::GetStyle().FramePadding.x;
}

float Widgets::lampWidth(const char* label) const {
    return buttonWidth(label) + 0.56f * ImGui::GetTextLineHeight() + units(7.0f);
}

bool Widgets::button(const char* name, const char* label, std::string_view note) {
    const bool pressed = ImGui::Button(label);
    mark(name, note);
    return pressed;
}

bool Widgets::check(const char* name, const char* label, bool& on) {
    const bool pressed = ImGui::Checkbox(label, &on);
    mark(name);
    return pressed;
}

bool Widgets::combo(const char* name, int& chosen, std::span<const char* const> labels) {
    ImGui::PushID(name);
    ImGui::PushItemWidth(-1.0f);
    const bool changed = ImGui::Combo("##combo", &chosen, labels.data(), static_cast<int>(labels.size()));
    mark(name);
    ImGui::PopItemWidth();
    ImGui::PopID();
    return changed;
}

bool Widgets::lampButton(const char* name, const char* label, bool on, unsigned color, const char* widest,
                         std::string_view note) {
    ImGui::PushID(name);
    const float line = ImGui::GetTextLineHeight(), radius = 0.28f * line;
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (!on)
        ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(0, 0, 0, 0));
    const bool pressed = ImGui::Button(
        "##lamp", ImVec2(std::max(lampWidth(label), lampWidth(widest)), line + 2.0f * style.FramePadding.y));
    if (!on)
        ImGui::PopStyleColor();
    mark(name, note);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 middle(at.x + style.FramePadding.x + radius, at.y + style.FramePadding.y + 0.5f * line);
    if (on)
        draw.AddCircleFilled(middle, radius, color);
    else
        draw.AddCircle(middle, radius, ImGui::GetColorU32(ImGuiCol_TextDisabled), 0, 1.5f);
    draw.AddText(ImVec2(middle.x + radius + units(7.0f), at.y + style.FramePadding.y),
                 ImGui::GetColorU32(on ? ImGuiCol_Text : ImGuiCol_TextDisabled), label);
    ImGui::PopID();
    return pressed;
}

bool Widgets::slider(const char* name, const char* label, float& value, const SliderRange& range,
                     const std::string& shown, std::string_view note) {
    ImGui::PushID(name);
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImVec2 low = ImGui::GetCursorScreenPos(),
                 high(low.x + ImGui::CalcItemWidth(), low.y + ImGui::GetFrameHeight());
    const bool typing = ImGui::TempInputIsActive(ImGui::GetID("##slider"));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (!typing) {
        const bool under = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(low, high);
        draw.AddRectFilled(low, high, ImGui::GetColorU32(under ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg),
                           style.FrameRounding);
        const float edge = low.x + (high.x - low.x) * fractionOf(value, range);
        // No knob: what lies under the number is the fill, and a line below it.
        if (edge > low.x + 0.5f) {
            draw.AddRectFilled(low, ImVec2(edge, high.y), ImGui::GetColorU32(ImGuiCol_SliderGrab, 0.4f),
                               style.FrameRounding, ImDrawFlags_RoundCornersLeft);
            draw.AddRectFilled(ImVec2(low.x, high.y - units(2.0f)), ImVec2(edge, high.y),
                               ImGui::GetColorU32(ImGuiCol_SliderGrab));
        }
        // ImGui's own frame, knob and number are not drawn.
        for (const ImGuiCol hidden : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive,
                                      ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive, ImGuiCol_Text})
            ImGui::PushStyleColor(hidden, IM_COL32(0, 0, 0, 0));
    }
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, units(2.0f)); // the pointer is at the fill's edge
    const bool changed =
        ImGui::SliderFloat("##slider", &value, range.low, range.high, formatFor(range).c_str(),
                           (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0) |
                               (range.clamp ? ImGuiSliderFlags_AlwaysClamp : 0));
    ImGui::PopStyleVar();
    if (!typing) {
        ImGui::PopStyleColor(6);
        const ImU32 text = ImGui::GetColorU32(ImGuiCol_Text);
        const float y = low.y + style.FramePadding.y;
        const float number = high.x - style.FramePadding.x - widthOf(shown);
        if (low.x + 2.0f * style.FramePadding.x + widthOf(label) <= number) // else the number alone
            draw.AddText(ImVec2(low.x + style.FramePadding.x, y), text, label);
        draw.AddText(ImVec2(number, y), text, shown.c_str());
    }
    mark(name, note);
    ImGui::PopID();
    return changed;
}

} // namespace touchstone
