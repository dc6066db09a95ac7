#include "workbench/panels/recording_list_panel.h"

#include "workbench/panels/colors.h"
#include "workbench/timeline/timeline_controller.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

std::string lengthText(const RecordingFacts& facts) {
    char text[32];
    const int minutes = static_cast<int>(facts.seconds / 60.0);
    if (minutes > 0)
        std::snprintf(text, sizeof text, "%d min %.0f s", minutes, facts.seconds - 60.0 * minutes);
    else
        std::snprintf(text, sizeof text, "%.1f s", facts.seconds);
    return facts.wholeLength ? text : "about " + std::string(text);
}

/// Does what the user asked for and keeps what became of it.
void act(TimelinePanelState& state, const std::string& done, const std::function<void()>& action) {
    state.renaming.reset();
    state.deleting.reset();
    try {
        action();
        state.outcome = done;
        state.failed = false;
    } catch (const std::exception& error) {
        state.outcome = error.what();
        state.failed = true;
    }
}

/// A cell in as many lines as the text needs.
void cell(const std::string& text, ImU32 color, const Widgets& widgets) {
    ImGui::TableNextColumn();
    widgets.wrapped(text, color);
}

/// The name while it is typed: Enter renames, Escape or a click elsewhere leaves it.
void nameField(const RecordingFacts& facts, TimelineController& controller, TimelinePanelState& state,
               Widgets& widgets) {
    if (std::exchange(state.nameBegins, false))
        ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    const bool done =
        ImGui::InputText("##name", state.name.data(), state.name.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    widgets.mark("recordingName");
    if (done)
        act(state, std::string("renamed to ") + state.name.c_str(),
            [&] { controller.rename(facts.file, state.name.c_str()); });
    else if (ImGui::IsItemDeactivated())
        state.renaming.reset();
}

void rowButtons(const RecordingFacts& facts, const std::string& name, TimelineController& controller,
                TimelinePanelState& state, Widgets& widgets) {
    if (state.deleting == facts.file) {
        ImGui::TextColored(ImColor(kAmber), "delete it?");
        ImGui::SameLine();
        // Under the pointer that pressed Delete...: a second click there keeps it.
        if (ImGui::SmallButton("Keep"))
            state.deleting.reset();
        widgets.mark("deleteNo");
        ImGui::SameLine();
        if (ImGui::SmallButton("Delete"))
            act(state, "deleted " + name, [&] { controller.remove(facts.file); });
        widgets.mark("deleteYes");
        return;
    }
    if (ImGui::SmallButton("Rename")) {
        state.renaming = facts.file;
        state.deleting.reset();
        state.nameBegins = true;
        const std::string stem = facts.file.stem().string();
        std::fill(state.name.begin(), state.name.end(), '\0');
        std::copy_n(stem.begin(), std::min(stem.size(), state.name.size() - 1), state.name.begin());
    }
    widgets.mark(("rename:" + name).c_str());
    ImGui::SameLine();
    if (ImGui::SmallButton("Delete..."))
        state.deleting = facts.file;
    widgets.mark(("delete:" + name).c_str());
}

/// Why it is listed beyond its being recorded; empty: no such reason.
std::string remarkOf(const RecordingFacts& facts) {
    return !facts.problem.empty()     ? "cannot be opened: " + facts.problem
           : !facts.reason.empty()    ? facts.reason
           : facts.madeBy == "window" ? ""
                                      : facts.madeBy;
}

std::string modelOf(const RecordingFacts& facts) {
    return facts.model.empty() ? "nothing touched" : facts.model;
}

/// In a table of two columns: what does not fit beside the name, below it.
void factsBelow(const RecordingFacts& facts, ImU32 remarkColor, Widgets& widgets) {
    const std::string what = facts.problem.empty() ? ", " + lengthText(facts) + ", " + modelOf(facts) : "";
    widgets.wrapped(facts.date + what, ImGui::GetColorU32(ImGuiCol_TextDisabled));
    if (const std::string remark = remarkOf(facts); !remark.empty())
        widgets.wrapped(remark, remarkColor);
}

/// `narrow`: the table has two columns.
void row(const RecordingFacts& facts, bool narrow, TimelineController& controller, TimelinePanelState& state,
         Widgets& widgets) {
    const std::string name = facts.file.filename().string();
    const ImU32 text = ImGui::GetColorU32(ImGuiCol_Text), grey = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const ImU32 remarkColor = !facts.problem.empty() ? kRed : facts.reason.empty() ? grey : kAmber;
    ImGui::TableNextColumn();
    if (state.renaming == facts.file) {
        nameField(facts, controller, state, widgets);
    } else {
        const bool open = controller.looking() && controller.timeline().file() == facts.file;
        const std::string lines = brokenLines(facts.file.stem().string(), ImGui::GetContentRegionAvail().x);
        // No higher than its row.
        const ImGuiStyle& style = ImGui::GetStyle();
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {style.ItemSpacing.x, 2.0f * style.CellPadding.y});
        if (ImGui::Selectable((lines + "###open").c_str(), open))
            state.open = facts.file;
        ImGui::PopStyleVar();
        widgets.mark(("recording:" + name).c_str(), facts.file.string());
    }
    if (narrow) {
        factsBelow(facts, remarkColor, widgets);
    } else {
        const bool opens = facts.problem.empty();
        cell(facts.date, grey, widgets);
        cell(opens ? lengthText(facts) : "", text, widgets);
        cell(opens ? modelOf(facts) : "", text, widgets);
        cell(remarkOf(facts), remarkColor, widgets);
    }
    ImGui::TableNextColumn();
    rowButtons(facts, name, controller, state, widgets);
}

/// On the line of the buttons above, so that no row moves.
void outcome(const TimelinePanelState& state, Widgets& widgets) {
    if (state.outcome.empty())
        return;
    ImGui::SameLine();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight();
    ImGui::PushClipRect(at, ImVec2(at.x + std::max(room, 0.0f), at.y + ImGui::GetFrameHeight()), true);
    ImGui::AlignTextToFramePadding();
    const std::string line = state.outcome.substr(0, state.outcome.find('\n'));
    ImGui::TextColored(ImColor(state.failed ? kRed : kGreen), "%s", line.c_str());
    ImGui::PopClipRect();
    widgets.mark("listOutcome", state.outcome);
}

} // namespace

void drawRecordingList(TimelineController& controller, TimelinePanelState& state, Widgets& widgets) {
    outcome(state, widgets);
    if (controller.list().recordings().empty()) {
        ImGui::TextDisabled(controller.list().read()
                                ? "Nothing is recorded yet: F9 begins and ends a recording."
                                : "Looking for recordings");
        return;
    }
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                       ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoSavedSettings;
    struct Heading {
        const char* name;
        float width;
    };
    constexpr std::array kHeadings{Heading{"name", 1.5f}, Heading{"date", 1.35f}, Heading{"length", 0.8f},
                                   Heading{"model", 1.2f}, Heading{"kept because", 1.6f}};
    const float buttons = ImGui::CalcTextSize("delete it? Delete Keep").x + widgets.units(62.0f);
    // Six columns where a date fits into its own.
    const float date = ImGui::CalcTextSize("2026-11-25 04:30").x + 2.0f * ImGui::GetStyle().CellPadding.x;
    float share = 0.0f;
    for (const Heading& heading : kHeadings)
        share += heading.width / kHeadings[1].width;
    const bool narrow = ImGui::GetContentRegionAvail().x < share * date + buttons + widgets.units(24.0f);
    const size_t columns = narrow ? 1 : kHeadings.size();
    if (!ImGui::BeginTable(narrow ? "narrow recordings" : "recordings", static_cast<int>(columns) + 1,
                           kFlags))
        return;
    for (const Heading& heading : std::span(kHeadings).first(columns))
        ImGui::TableSetupColumn(heading.name, ImGuiTableColumnFlags_WidthStretch, heading.width);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, buttons);
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableHeadersRow();
    const std::vector<RecordingFacts> recordings = controller.list().recordings(); // rows may change it
    for (const RecordingFacts& facts : recordings) {
        ImGui::TableNextRow();
        ImGui::PushID(facts.file.c_str());
        row(facts, narrow, controller, state, widgets);
        ImGui::PopID();
    }
    ImGui::EndTable();
}

} // namespace touchstone
