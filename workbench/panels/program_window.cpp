#include "workbench/panels/program_window.h"

#include "workbench/figures/quantity.h"
#include "workbench/panels/colors.h"

#include <imgui.h>
#include <imgui_internal.h> // the child of a text field, for its place in the text
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace touchstone {

namespace {

constexpr ImU32 kWrongLine = IM_COL32(96, 38, 34, 255), kLineNumber = IM_COL32(120, 126, 133, 255);

constexpr const char* kSpace =
    "Space types a space and switches the force off (Force in the bar gives it back); "
    "Tab leaves it on.";

size_t linesOf(std::string_view text) {
    return static_cast<size_t>(std::ranges::count(text, '\n')) + 1;
}

/// The line of a number from 1; empty: there is none.
std::string_view lineOf(std::string_view text, size_t number) {
    for (size_t line = 1; line < number; ++line) {
        const size_t end = text.find('\n');
        if (end == std::string_view::npos)
            return {};
        text.remove_prefix(end + 1);
    }
    return text.substr(0, text.find('\n'));
}

/// How the text now relates to what is felt.
void outcome(const EditedProgram& program, Widgets& widgets) {
    if (program.overtaken)
        widgets.wrapped("The file has changed, too: Revert takes it, Save replaces it.", kFailure);
    if (program.compiling) {
        widgets.wrapped("compiling ...");
    } else if (!program.problem.empty()) {
        widgets.wrapped(problemText(program) + (program.program != nullptr ? "; the last good program stays"
                                                                           : "; the surface is plain"),
                        kFailure);
        widgets.mark("program.problem", problemText(program));
    } else if (!program.fault.problem.empty()) {
        const std::string text = program::textOf(program.fault);
        widgets.wrapped(text + "; the surface is plain", kFailure);
        widgets.mark("program.fault", text);
    } else if (program.felt >= 0.0 && program.seen >= 0.0) {
        widgets.wrapped("felt after " + figure(program.felt, 2) + " s, seen after " +
                            figure(program.seen, 2) + " s" + (program.edited() ? "; not saved" : ""),
                        kSuccess);
    } else {
        widgets.wrapped(program.edited() ? "not saved" : "as in the file",
                        ImGui::GetColorU32(ImGuiCol_TextDisabled));
    }
}

/// What stands at a line of the text: that it does not compile, or else why it has no result.
struct LineNote {
    size_t line = 0; ///< from 1; 0: none
    std::string text{};
};

LineNote noteOf(const EditedProgram& program) {
    if (program.compiling)
        return {};
    const bool compiles = program.problem.empty();
    const std::string& problem = compiles ? program.fault.problem : program.problem;
    return {compiles ? program.fault.line : program.line, problem.substr(0, problem.find(';'))};
}

/// Numbers of the lines left of the text, and the problem behind its line. `shown`: the child that scrolls
/// the text.
void annotate(const EditedProgram& program, const ImGuiWindow& shown, float left) {
    const LineNote note = noteOf(program);
    const float height = ImGui::GetTextLineHeight();
    const ImRect clip = shown.InnerClipRect;
    const float top = shown.Pos.y + ImGui::GetStyle().FramePadding.y - shown.Scroll.y;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect({left, clip.Min.y}, {shown.Pos.x, clip.Max.y}, true);
    const auto first = static_cast<size_t>(std::max(0.0f, shown.Scroll.y / height - 1.0f));
    const size_t lines = linesOf(program.text);
    for (size_t line = first + 1; line <= lines; ++line) {
        const float y = top + height * static_cast<float>(line - 1);
        if (y > clip.Max.y)
            break;
        if (y + height > clip.Max.y || y < clip.Min.y)
            continue; // whole numbers only
        const std::string number = std::to_string(line);
        const bool wrong = line == note.line;
        if (wrong)
            draw.AddRectFilled({left, y}, {shown.Pos.x, y + height}, kWrongLine);
        draw.AddText({shown.Pos.x - height * 0.4f - ImGui::CalcTextSize(number.c_str()).x, y},
                     wrong ? kFailure : kLineNumber, number.c_str());
    }
    draw.PopClipRect();
    if (note.line == 0)
        return;
    const std::string_view own = lineOf(program.text, note.line);
    const float space = 0.5f * height;
    const float end = clip.Min.x + ImGui::GetStyle().FramePadding.x +
                      ImGui::CalcTextSize(own.data(), own.data() + own.size()).x + 2.0f * space;
    const float room = clip.Max.x - clip.Min.x - 2.0f * space;
    const std::string message = shortened(note.text, room);
    const float width = ImGui::CalcTextSize(message.c_str()).x;
    const float x = std::max(clip.Min.x + space, std::min(end, clip.Max.x - width - space));
    float y = top + height * static_cast<float>(note.line - 1);
    if (x < end) // no room behind it
        y += height;
    if (y < clip.Min.y || y + height > clip.Max.y)
        return;
    shown.DrawList->PushClipRect(clip.Min, clip.Max, false);
    shown.DrawList->AddRectFilled({x - 0.5f * space, y}, {x + width + 0.5f * space, y + height}, kWrongLine,
                                  0.25f * height);
    shown.DrawList->AddText({x, y}, kFailure, message.c_str());
    shown.DrawList->PopClipRect();
}

/// The window that InputTextMultiline makes.
const ImGuiWindow* childOf(const char* field) {
    std::array<char, 256> name{};
    const ImGuiWindow* const window = ImGui::GetCurrentWindow();
    std::snprintf(name.data(), name.size(), "%s/%s_%08X", window->Name, field, ImGui::GetID(field));
    return ImGui::FindWindowByName(name.data());
}

void text(size_t source, ProgramEditor& programs, ProgramPanelState& state, Widgets& widgets) {
    constexpr const char* kField = "##program";
    const EditedProgram& program = programs.sources()[source];
    const float left = ImGui::GetCursorScreenPos().x;
    const float column = ImGui::CalcTextSize("000").x + widgets.units(8.0f);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + column);
    state.text = program.text;
    if (ImGui::InputTextMultiline(kField, &state.text, {-1.0f, -1.0f}, ImGuiInputTextFlags_AllowTabInput))
        programs.type(source, state.text);
    widgets.mark("program.text");
    if (const ImGuiWindow* const shown = childOf(kField))
        annotate(program, *shown, left);
}

} // namespace

void drawProgramWindow(const WidgetRect& picture, ProgramEditor& programs, ProgramPanelState& state,
                       Widgets& widgets) {
    if (!state.open || state.source >= programs.sources().size())
        return;
    constexpr float kWidth = 620.0f, kHeight = 420.0f, kWindowMargin = 8.0f; // units
    const float margin = widgets.units(kWindowMargin);
    const ImVec2 room(std::max(1.0f, picture.width - 2.0f * margin),
                      std::max(1.0f, picture.height - 2.0f * margin));
    const ImVec2 size(std::min(room.x, widgets.units(kWidth)), std::min(room.y, widgets.units(kHeight)));
    ImGui::SetNextWindowPos(
        {picture.x + picture.width - margin - size.x, picture.y + picture.height - margin - size.y},
        ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(size, ImGuiCond_FirstUseEver);
    const EditedProgram& program = programs.sources()[state.source];
    // As the material editor: another scale begins with another window.
    const std::string title = program.name + "###program" + std::to_string(widgets.units(1.0f));
    if (ImGui::Begin(title.c_str(), &state.open, ImGuiWindowFlags_NoSavedSettings)) {
        if (program.program != nullptr) {
            programs.measure(state.source);
            widgets.wrapped(costText(program.cost), ImGui::GetColorU32(ImGuiCol_TextDisabled));
        }
        outcome(program, widgets);
        widgets.wrapped(kSpace, ImGui::GetColorU32(ImGuiCol_TextDisabled));
        widgets.mark("program.space", kSpace);
        if (program.edited() || program.overtaken)
            if (widgets.button("program.revert", "Revert"))
                programs.revert(state.source);
        text(state.source, programs, state, widgets);
    }
    ImGui::End();
}

} // namespace touchstone
