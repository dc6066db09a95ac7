#include "workbench/figures/quantity.h"
#include "workbench/figures/ui_scale.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/effect_switch.h"
#include "workbench/panels/notes.h"
#include "workbench/panels/panels.h"
#include "workbench/screen/view_menu.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

namespace touchstone {

namespace {

/// The next popup opens beneath the last widget.
void beneath() {
    ImGui::SetNextWindowPos(ImVec2(ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y + 4.0f));
}

/// A file as a menu item.
void fileItem(const std::filesystem::path& file, const std::string& beside, PanelState& state) {
    ImGui::PushID(file.c_str());
    const std::string name = file.filename().string();
    if (ImGui::MenuItem(name.c_str(), beside.c_str()))
        state.open = file;
    ImGui::PopID();
}

void fileMenu(const PanelInput& input, PanelState& state, Widgets& widgets) {
    if (ImGui::Button("File"))
        ImGui::OpenPopup("file");
    widgets.mark("file");
    beneath();
    if (!ImGui::BeginPopup("file"))
        return;
    if (ImGui::MenuItem("Open...", "Ctrl+O"))
        state.openPressed = true;
    widgets.mark("menu:open");
    if (ImGui::MenuItem("Recordings")) {
        state.timeline.shown = state.timeline.list = true;
        state.folds.bottom = false;
    }
    widgets.mark("menu:recordings");
    ImGui::Separator();
    if (ImGui::MenuItem("Gallery", "Ctrl+G"))
        state.gallery = true;
    widgets.mark("gallery");
    ImGui::Separator();
    ImGui::TextDisabled("samples");
    for (size_t i = 0; i < input.samples.size(); ++i) {
        const std::filesystem::path& file = input.samples[i];
        fileItem(file, input.sampleNotes[i], state);
        widgets.mark(("sample:" + file.filename().string()).c_str());
    }
    if (!input.recent.empty()) {
        ImGui::Separator();
        ImGui::TextDisabled("opened before");
        for (const std::filesystem::path& file : input.recent) {
            fileItem(file, "", state);
            widgets.mark(("menu:recent:" + file.filename().string()).c_str(), file.string());
        }
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Save the picture", "F12"))
        state.view.savePicture = true;
    widgets.mark("menu:savePicture");
    if (ImGui::MenuItem("Quit", "Ctrl+Q"))
        state.quitPressed = true;
    widgets.mark("menu:quit");
    ImGui::EndPopup();
}

/// Smaller and larger type, and what fits the window.
void uiScale(const PanelInput& input, PanelState& state, Widgets& widgets) {
    ImGui::AlignTextToFramePadding();
    ImGui::Text("UI scale %s %%", figure(100.0 * static_cast<double>(state.uiScale)).c_str());
    widgets.mark("uiScale");
    ImGui::SameLine();
    if (widgets.button("smaller", "-"))
        state.uiScale = steppedUiScale(state.uiScale, -1);
    ImGui::SameLine();
    if (widgets.button("larger", "+"))
        state.uiScale = steppedUiScale(state.uiScale, 1);
    if (!input.scaleFits) {
        ImGui::SameLine();
        ImGui::TextDisabled("more than fits this window");
    }
}

void viewMenu(const PanelInput& input, PanelState& state, Widgets& widgets) {
    if (ImGui::Button("View"))
        ImGui::OpenPopup("view");
    widgets.mark("viewMenu");
    beneath();
    const float width = widgets.units(390.0f),
                top = ImGui::GetItemRectMax().y + ImGui::GetStyle().ItemSpacing.y;
    // It scrolls in a window that is less high.
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0.0f),
                                        ImVec2(width, std::max(1.0f, ImGui::GetIO().DisplaySize.y - top)));
    ImGui::SetNextWindowSize(ImVec2(width, 0.0f));
    if (!ImGui::BeginPopup("view"))
        return;
    drawViewMenu(state.view, [&](const char* name) { widgets.mark(name); });
    ImGui::Separator();
    drawClip(input, state, widgets);
    ImGui::Separator();
    const auto fold = [&](const char* label, const char* key, bool& folded) {
        bool shown = !folded;
        if (ImGui::MenuItem(label, key, &shown))
            folded = !shown;
        widgets.mark((std::string("panel:") + key).c_str());
    };
    fold("Scene", "F2", state.folds.left);
    fold("What is felt", "F3", state.folds.right);
    fold("Charts", "F4", state.folds.bottom);
    ImGui::Separator();
    uiScale(input, state, widgets);
    ImGui::EndPopup();
}

template <class Mode>
void effect(Widgets& widgets, const char* name, const char* label, const EffectSwitch<Mode>& effect,
            PanelState& state) {
    effect.remember(state);
    if (widgets.lampButton(name, label, effect.on(state), kBlue))
        effect.toggle(state);
}

void effects(PanelState& state, Widgets& widgets) {
    effect(widgets, "forceShading", "Shading", kShadingSwitch, state);
    ImGui::SameLine();
    effect(widgets, "texture", "Texture", kTextureSwitch, state);
    ImGui::SameLine();
    effect(widgets, "friction", "Friction", kFrictionSwitch, state);
}

void force(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const bool latched = has(input.servo->last.output.flags, TickFlag::SafetyLatched);
    bool& on = state.settings.forceEnabled;
    const bool looking = state.timeline.looking;
    const char* label = latched ? "Force: fault" : on && !looking ? "Force on" : "Force off";
    const char* const note = !looking ? ""
                             : on     ? "Off while a recording is open; on again with the live hand"
                                      : "Stays off with the live hand";
    if (widgets.lampButton("forceEnabled", label, on && !looking, latched ? kRed : kGreen, "Force: fault",
                           note))
        on = !on && !looking;
}

void record(const PanelInput& input, PanelState& state, Widgets& widgets) {
    char label[32] = "Record";
    if (input.recording)
        std::snprintf(label, sizeof label, "Stop %.0f s", input.recordedSeconds);
    if (widgets.lampButton("record", label, input.recording, kRed, "Stop 0000 s", input.recordingFile))
        state.recordPressed = true;
}

/// Right end of the bar: the servo's rate and its 99th percentile, and help.
void servoLamp(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const ServoView& servo = *input.servo;
    char text[64];
    std::snprintf(text, sizeof text, "%.2f kHz  p99 %.0f µs", 1e-3 * servo.ticksPerSecond, servo.stepP99Us);
    const float line = ImGui::GetTextLineHeight(), radius = 0.28f * line;
    const float width = ImGui::CalcTextSize(text).x + 2.0f * radius + widgets.units(8.0f);
    const float help = ImGui::CalcTextSize("?").x + 2.0f * ImGui::GetStyle().FramePadding.x;
    const float from = ImGui::GetWindowContentRegionMax().x - help - widgets.units(10.0f) - width;
    ImGui::SameLine();
    if (from >= ImGui::GetCursorPosX()) {
        const bool well = servo.ticksPerSecond > 0.98 * servo.rateHz;
        ImGui::SetCursorPosX(from);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled(
            ImVec2(at.x + radius, at.y + 0.5f * ImGui::GetFrameHeight()), radius, well ? kGreen : kAmber);
        ImGui::SetCursorPosX(from + 2.0f * radius + widgets.units(8.0f));
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(text);
        widgets.mark("servo", noteOf("servo") + "\n" + figure(servo.rateHz, 4) + " Hz, " + servo.scheduling);
        ImGui::SameLine();
    }
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - help);
    if (widgets.button("help", "?"))
        state.help = !state.help;
}

} // namespace

void drawTopBar(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const float gap = widgets.units(18.0f);
    fileMenu(input, state, widgets);
    ImGui::SameLine();
    viewMenu(input, state, widgets);
    ImGui::SameLine(0.0f, gap);
    effects(state, widgets);
    ImGui::SameLine(0.0f, gap);
    force(input, state, widgets);
    ImGui::SameLine();
    record(input, state, widgets);
    if (state.walking) {
        constexpr const char* kWalking = "Arrows work the panels (Escape)";
        ImGui::SameLine(0.0f, gap);
        if (ImGui::GetContentRegionAvail().x >
            ImGui::CalcTextSize(kWalking).x + Widgets::buttonWidth("?") + gap)
            ImGui::TextColored(ImColor(kAmber), kWalking);
        else
            ImGui::NewLine();
    }
    servoLamp(input, state, widgets);
}

} // namespace touchstone
