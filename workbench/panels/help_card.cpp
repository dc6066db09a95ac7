#include "workbench/panels/card.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <span>

namespace touchstone {

namespace {

struct Line {
    const char *key, *meaning;
};
struct Topic {
    const char* title;
    std::span<const Line> lines;
};

constexpr Line kTouch[]{
    {"Left button, drag", "touches what is pointed at, strokes it"},
    {"Wheel", "presses harder or more lightly"},
    {"G", "the mouse moves its hand free in space"},
    {"Space", "switches the force off and on"},
    {"S", "lets the force be heard"},
    {"F5, F6, F7", "switch shading, texture and friction"},
    {"F8", "changes between mouse and simulated hand"},
    {"N; with Shift", "the hand's next stroke; the one before"},
    {"C held; Shift+C", "the device's clutch; centres the device"},
    {"Page Up, Down", "zoom of the device: farther, finer"},
};
constexpr Line kRecord[]{
    {"F9", "begins and ends a recording"},        {"P", "pauses the charts"},
    {"K", "plays a recording that is looked at"}, {"Left, Right; with Shift", "a tick back, on; 100 ms"},
    {"Home, End", "its begin, its end"},          {"A, B; Shift+A", "a loop begins, ends; no loop"},
    {"Escape", "back to the live hand"},
};
constexpr Line kEdit[]{
    {"E", "opens and closes the material editor"},
    {"Ctrl+Z, Ctrl+Shift+Z", "take a change back, make it again"},
    {"Ctrl+S", "saves the materials into the file"},
};
constexpr Line kSculpt[]{
    {"B", "sculpts what is felt as a field, or touches"},
    {"I", "paints it, while it is sculpted"},
    {"Left button; D held", "the tool works; for a device"},
    {"Ctrl, Shift held", "the opposite tool; smooths"},
    {"F, Shift+F; pointer", "radius; strength"},
};
constexpr Line kLook[]{
    {"Right or middle drag", "turns the view; Shift shifts, Ctrl zooms"},
    {"Alt + left drag", "turns the view, too"},
    {"Ctrl + wheel, + and -", "zooms"},
    {"Arrow keys; with Shift", "turn the view; shift it"},
    {"Home or F", "shows all"},
    {"1, 3, 7; with Ctrl", "front, right, above; the other side"},
    {". and T", "near the probe; turntable"},
    {"H; with Shift, Alt", "hides what is pointed at; all else; shows all"},
    {"Right click", "the menu of the object"},
    {"X", "what is felt as a field, in a slice"},
    {"Alt + B", "clipping plane across the view"},
    {"5, Z, L", "orthographic, wireframe, grid"},
    {"V; with Shift", "the next view; the one before"},
    {"M and O", "magnifier; overlays"},
    {"R", "puts bodies that moved back"},
    {"J; left button held", "grasps bodies; holds the one that is touched"},
    {"F12", "saves the picture"},
};
constexpr Line kWindow[]{
    {"F2, F3, F4; Tab", "fold the scene, what is felt, the charts; all"},
    {"F10, Escape", "arrows and Enter work the panels; leaves them"},
    {"Ctrl+O", "opens a model or a recording; or drop it here"},
    {"Ctrl+G", "our scenes and what was opened before"},
    {"Ctrl+Shift, + and -", "larger and smaller type"},
    {"Ctrl+Q", "quits"},
    {"F1 or ?, Escape", "shows this; puts it away"},
};
constexpr Topic kLeft[]{{"TOUCH", kTouch}, {"RECORD", kRecord}, {"CHANGE", kEdit}, {"SCULPT", kSculpt}},
    kRight[]{{"LOOK", kLook}, {"THE WINDOW", kWindow}};

void drawTopics(std::span<const Topic> topics, const Widgets& widgets) {
    ImGui::BeginGroup();
    for (const Topic& topic : topics) {
        ImGui::TextDisabled("%s", topic.title);
        for (const Line& line : topic.lines) {
            ImGui::TextUnformatted(line.key);
            ImGui::SameLine(widgets.units(150.0f)); // from the start of the group
            ImGui::TextDisabled("%s", line.meaning);
        }
        ImGui::Dummy(ImVec2(0.0f, widgets.units(6.0f)));
    }
    ImGui::EndGroup();
}

} // namespace

void drawHelp(const PanelInput& input, PanelState& state, Widgets& widgets) {
    if (!state.help)
        return;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * display.x, 0.5f * display.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    // Scrolls in a window too small for all of it.
    ImGui::SetNextWindowSizeConstraints(ImVec2(0.0f, 0.0f), display);
    ImGui::SetNextWindowBgAlpha(1.0f);
    if (beginCardWindow("help", widgets, kAnsweredCard)) {
        drawTopics(kLeft, widgets);
        constexpr float kTwoColumns = 940.0f; // units
        if (display.x >= widgets.units(kTwoColumns))
            ImGui::SameLine(0.0f, widgets.units(28.0f));
        drawTopics(kRight, widgets);
        ImGui::Separator();
        if (widgets.button("helpClose", "Close"))
            state.help = false;
        ImGui::SameLine();
        ImGui::TextDisabled("%s, %d x %d", input.gpuName.c_str(), input.sceneSize.x, input.sceneSize.y);
    }
    ImGui::End();
}

} // namespace touchstone
