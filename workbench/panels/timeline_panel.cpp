#include "workbench/panels/timeline_panel.h"

#include "workbench/panels/card.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/recording_list_panel.h"
#include "workbench/panels/timeline_curves.h"
#include "workbench/screen/keys.h"
#include "workbench/screen/native_key.h"
#include "workbench/timeline/timeline_controller.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>

namespace touchstone {

namespace {

constexpr double kShiftStep = 0.1; // s

/// `widest`: a label for which it has room, where its own changes and nothing beside it must move.
bool button(const char* label, const char* name, Widgets& widgets, const char* widest = "") {
    const float width = std::max(Widgets::buttonWidth(label), Widgets::buttonWidth(widest));
    widgets.besideArrow(width);
    const bool pressed = ImGui::Button(label, ImVec2(width, 0.0f));
    widgets.mark(name);
    return pressed;
}

void transport(TimelineController& controller, Widgets& widgets) {
    Playback& at = controller.playback();
    if (button("|<", "toBegin", widgets))
        at.toBegin();
    if (button("<", "stepBack", widgets))
        at.step(-1);
    if (button(at.playing() ? "Pause##play" : "Play##play", "play", widgets, "Pause")) {
        controller.stopTouchingAgain();
        at.play(!at.playing());
    }
    if (button(">", "stepOn", widgets))
        at.step(1);
    if (button(">|", "toEnd", widgets))
        at.toEnd();
    widgets.besideArrow(widgets.units(66.0f));
    ImGui::SetNextItemWidth(widgets.units(66.0f));
    char speed[16];
    std::snprintf(speed, sizeof speed, "%gx", at.speed());
    if (ImGui::BeginCombo("##speed", speed)) {
        for (const double choice : Playback::kSpeeds) {
            std::snprintf(speed, sizeof speed, "%gx", choice);
            if (ImGui::Selectable(speed, choice == at.speed()))
                at.setSpeed(choice);
            widgets.mark((std::string("speed:") + speed).c_str());
        }
        ImGui::EndCombo();
    }
    widgets.mark("speed");
    if (button("A", "markBegin", widgets))
        at.markBegin();
    if (button("B", "markEnd", widgets))
        at.markEnd();
    ImGui::BeginDisabled(!at.beginMark() && !at.endMark()); // there all the time: nothing beside it moves
    if (button("x", "clearMarks", widgets))
        at.clearMarks();
    ImGui::EndDisabled();
}

void examination(TimelineController& controller, Widgets& widgets) {
    char label[48] = "Verify";
    if (controller.verifying())
        std::snprintf(label, sizeof label, "Stop %.0f %%", 100.0 * controller.verifyingFraction());
    if (button((std::string(label) + "##verify").c_str(), "verify", widgets, "Stop 100 %")) {
        if (controller.verifying())
            controller.cancelVerifying();
        else
            controller.verify();
    }
    const bool again = controller.again().running();
    const char* const text = again ? "Stop" : "Touch again";
    widgets.besideArrow(widgets.lampWidth("Touch again"));
    const char* const note = controller.modelIsOpen() ? "" : "The model that was touched is not open";
    if (widgets.lampButton("touchAgain", text, again, kBlue, "Touch again", note)) {
        if (again)
            controller.stopTouchingAgain();
        else if (controller.modelIsOpen())
            controller.touchAgain();
    }
}

/// The settings of now beside those of then, over the whole recording.
void comparison(TimelineController& controller, Widgets& widgets) {
    const bool on = controller.comparison().wanted();
    widgets.besideArrow(widgets.lampWidth("Compare"));
    if (widgets.lampButton("compare", "Compare", on, kGreen))
        controller.compare(!on);
}

/// Last on its line: it comes and goes.
void openModel(TimelineController& controller, Widgets& widgets) {
    if (!controller.modelIsOpen() && controller.modelFile() && button("Open its model", "openModel", widgets))
        controller.wantModel();
}

struct News {
    std::string text;
    ImU32 color;
};

/// The result of a replay, or a notice.
News newsOf(const TimelineController& controller) {
    const TouchAgain::Means means = controller.again().means();
    char text[160];
    if (means.ticks > 0) {
        std::snprintf(text, sizeof text, "then %.3f N, again %.3f N, on average in contact", means.recorded,
                      means.now);
        return {text, kBlue};
    }
    const SettingsComparison& comparison = controller.comparison();
    if (comparison.result() != nullptr)
        return {comparison.result()->text(), kGreen};
    if (!comparison.problem().empty())
        return {comparison.problem(), kRed};
    if (comparison.busy()) {
        std::snprintf(text, sizeof text, "touching it again with the settings of now: %.0f %%",
                      100.0 * comparison.fraction());
        return {text, kGreen};
    }
    if (controller.again().running())
        return {"the hand is on its way to where the recording begins", kBlue};
    if (!controller.verdict().empty())
        return {controller.verdict(), controller.verdictEqual() ? kGreen : kRed};
    if (!controller.notes().empty())
        return {controller.notes().front() + (controller.notes().size() > 1 ? " …" : ""), kAmber};
    const Timeline& timeline = controller.timeline();
    return {timeline.file().filename().string() + ", made by " + timeline.origin().command + ", " +
                std::to_string(timeline.size()) + " ticks",
            ImGui::GetColorU32(ImGuiCol_TextDisabled)};
}

/// As many lines as needed, two at most, one where the strips would have no room; the rest is cut off and
/// shown in the tooltip.
float heightOf(const News& news, float strips) {
    const float wrap = ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight();
    const float most = ImGui::GetContentRegionAvail().y - strips < 2.0f * line ? line : 2.0f * line;
    return std::min(ImGui::CalcTextSize(news.text.c_str(), nullptr, false, wrap).y, most);
}

void tell(const News& news, float height, const TimelineController& controller, Widgets& widgets) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, height);
    const ImVec4 clip(at.x, at.y, at.x + size.x, at.y + size.y);
    ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, news.color,
                                        news.text.c_str(), nullptr, size.x, &clip);
    ImGui::Dummy(size);
    widgets.mark("recordingNews");
    if (!ImGui::IsItemHovered())
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(widgets.units(600.0f));
    ImGui::TextUnformatted(controller.timeline().file().c_str());
    if (controller.comparison().result() != nullptr)
        ImGui::TextUnformatted(controller.comparison().result()->text().c_str());
    if (!controller.verdict().empty())
        ImGui::TextUnformatted(controller.verdict().c_str());
    for (const std::string& note : controller.notes())
        ImGui::TextUnformatted(note.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

} // namespace

bool followController(const TimelineController& controller, TimelinePanelState& state) {
    const bool begun = controller.looking() && !state.looking;
    if (controller.looking() != state.looking)
        state.shown = controller.looking();
    if (begun)
        state.list = false;
    state.looking = controller.looking();
    return begun;
}

void drawTimeline(TimelineController& controller, TimelinePanelState& state, Widgets& widgets) {
    if (!controller.looking())
        return drawRecordingList(controller, state, widgets);
    if (state.list) {
        widgets.besideArrow(widgets.lampWidth("List"));
        if (widgets.lampButton("recordings", "List", true, kBlue))
            state.list = false;
        return drawRecordingList(controller, state, widgets);
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        ImVec2(widgets.units(4.0f), ImGui::GetStyle().ItemSpacing.y));
    transport(controller, widgets);
    examination(controller, widgets);
    comparison(controller, widgets);
    widgets.besideArrow(widgets.lampWidth("List"));
    if (widgets.lampButton("recordings", "List", false, kBlue))
        state.list = true;
    openModel(controller, widgets);
    ImGui::PopStyleVar();
    const float gap = ImGui::GetStyle().ItemSpacing.y;
    const News news = newsOf(controller);
    const float newsHeight = heightOf(news, widgets.units(2.0f * 24.0f) + 2.0f * gap);
    const float room = ImGui::GetContentRegionAvail().y - newsHeight - 2.0f * gap;
    const float overview = std::clamp(0.5f * room, widgets.units(24.0f), widgets.units(44.0f));
    drawOverview(controller, overview, widgets);
    ImGui::Dummy(ImVec2(0.0f, 0.0f));
    drawNear(controller, state, std::max(room - overview, widgets.units(24.0f)), widgets);
    ImGui::Dummy(ImVec2(0.0f, 0.0f));
    tell(news, newsHeight, controller, widgets);
}

void drawLookingCard(TimelineController& controller, const WidgetRect& picture, Widgets& widgets) {
    if (!controller.looking())
        return;
    const float margin = widgets.units(12.0f);
    ImGui::SetNextWindowPos(ImVec2(picture.x + 0.5f * picture.width, picture.y + picture.height - margin),
                            ImGuiCond_Always, ImVec2(0.5f, 1.0f));
    ImGui::SetNextWindowBgAlpha(0.88f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(widgets.units(12.0f), widgets.units(8.0f)));
    if (beginCardWindow("looking", widgets)) {
        ImGui::AlignTextToFramePadding();
        constexpr const char* kBack = "Back to the live hand";
        const char* const text = controller.again().running()
                                     ? "The recorded hand touches again; the force is off"
                                     : "A recording; the force is off";
        const float room = picture.width - widgets.units(50.0f);
        const bool oneLine =
            ImGui::CalcTextSize(text).x + Widgets::buttonWidth(kBack) + ImGui::GetStyle().ItemSpacing.x <
            room;
        ImGui::TextColored(ImColor(kAmber), "%s", brokenLines(text, room).c_str());
        if (oneLine)
            ImGui::SameLine();
        if (widgets.button("backToLive", kBack))
            controller.leave();
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void timelineKeys(TimelineController& controller) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!controller.looking() || io.WantTextInput || io.KeyCtrl || io.KeyAlt || io.KeySuper)
        return;
    Playback& at = controller.playback();
    const bool shift = io.KeyShift;
    const auto stepOnce = [&](int direction) {
        controller.stopTouchingAgain();
        at.play(false);
        if (shift)
            at.stepSeconds(direction * kShiftStep);
        else
            at.step(direction);
    };
    if (ImGui::IsKeyPressed(nativeKey(GLFW_KEY_LEFT))) // repeats while held
        stepOnce(-1);
    if (ImGui::IsKeyPressed(nativeKey(GLFW_KEY_RIGHT)))
        stepOnce(1);
    if (keyPressed(GLFW_KEY_HOME))
        at.toBegin();
    if (keyPressed(GLFW_KEY_END))
        at.toEnd();
    if (keyPressed(keyOf('k'))) {
        controller.stopTouchingAgain();
        at.play(!at.playing());
    }
    if (keyPressed(keyOf('a'))) {
        if (shift)
            at.clearMarks();
        else
            at.markBegin();
    }
    if (keyPressed(keyOf('b')))
        at.markEnd();
}

} // namespace touchstone
