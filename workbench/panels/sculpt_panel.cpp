#include "workbench/figures/quantity.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"
#include "workbench/screen/keys.h"
#include "workbench/screen/native_key.h"

#include <glm/gtc/color_space.hpp>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

/// The shelf: Stamp and Imprint are one button, as are the others with Ctrl.
constexpr std::array kShelf{std::pair{SculptTool::Carve, "Carve"},     std::pair{SculptTool::Add, "Add"},
                            std::pair{SculptTool::Smooth, "Smooth"},   std::pair{SculptTool::Stamp, "Stamp"},
                            std::pair{SculptTool::Imprint, "Imprint"}, std::pair{SculptTool::Drag, "Drag"},
                            std::pair{SculptTool::Paint, "Paint"}};

std::string percent(double value) {
    return figure(100.0 * value) + " %";
}

void shelf(SculptChoice& choice, Widgets& widgets) {
    const SculptTool now = toolOf(choice);
    bool first = true;
    for (const auto& [tool, label] : kShelf) {
        if (!first)
            widgets.beside(widgets.lampWidth(label));
        first = false;
        const std::string name = std::string("sculpt:tool:") + infoOf(tool).name;
        if (widgets.lampButton(name.c_str(), label, now == tool, kBlue))
            choice.tool = tool;
    }
}

void stamps(const std::vector<std::string>& names, SculptChoice& choice, Widgets& widgets) {
    std::vector<const char*> labels;
    for (const std::string& name : names)
        labels.push_back(name.c_str());
    if (labels.empty())
        return;
    const auto found = std::ranges::find(names, choice.stamp);
    int chosen = found == names.end() ? 0 : static_cast<int>(found - names.begin());
    if (widgets.combo("sculpt:stamp", chosen, labels))
        choice.stamp = names[static_cast<size_t>(chosen)];
}

/// Shown as on the screen (sRGB), kept linear.
void paintColor(SculptChoice& choice, Widgets& widgets) {
    glm::vec3 shown = glm::convertLinearToSRGB(choice.color);
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::ColorEdit3("##sculpt:color", &shown.x, ImGuiColorEditFlags_DisplayHex))
        choice.color = glm::clamp(glm::convertSRGBToLinear(shown), 0.0f, 1.0f);
    ImGui::PopItemWidth();
    widgets.mark("sculpt:color");
}

void sliders(SculptChoice& choice, Widgets& widgets) {
    auto radius = static_cast<float>(1e3 * choice.radius);
    ImGui::PushItemWidth(-1.0f);
    if (widgets.slider("sculpt:radius", "Radius (F)", radius,
                       {static_cast<float>(1e3 * kMinSculptRadius),
                        static_cast<float>(1e3 * kMaxSculptRadius), true, true},
                       figure(1e3 * choice.radius, 2) + " mm"))
        choice.radius = 1e-3 * static_cast<double>(radius);
    auto strength = static_cast<float>(choice.strength);
    if (widgets.slider("sculpt:strength", "Strength (Shift+F)", strength, {0.01f, 1.0f, false, true},
                       percent(choice.strength)))
        choice.strength = static_cast<double>(strength);
    auto falloff = static_cast<float>(choice.falloff);
    if (widgets.slider("sculpt:falloff", "Falloff", falloff, {0.0f, 1.0f, false, true},
                       percent(choice.falloff)))
        choice.falloff = static_cast<double>(falloff);
    ImGui::PopItemWidth();
}

void history(const SculptStatus& status, SculptChoice& choice, Widgets& widgets) {
    const SculptFigures& figures = status.figures;
    ImGui::BeginDisabled(figures.undoSteps == 0);
    choice.undo = widgets.button("sculpt:undo", "Undo") || choice.undo;
    ImGui::EndDisabled();
    widgets.beside(Widgets::buttonWidth("Redo"));
    ImGui::BeginDisabled(figures.redoSteps == 0);
    choice.redo = widgets.button("sculpt:redo", "Redo") || choice.redo;
    ImGui::EndDisabled();
    widgets.beside(Widgets::buttonWidth("Save as..."));
    choice.saveAs = widgets.button("sculpt:saveAs", "Save as...") || choice.saveAs;
    if (figures.dabs > 0)
        widgets.wrapped(std::to_string(figures.undoSteps) + " strokes, " + figure(1e9 * figures.removed, 1) +
                        " mm3 removed");
    for (const std::string* note : {&figures.problem, &status.notice})
        if (!note->empty())
            widgets.wrapped(*note);
}

} // namespace

void sculptKeys(SculptChoice& choice, bool looking) {
    if (!looking && keyPressed(keyOf('b')))
        choice.on = !choice.on;
    const ImGuiIO& io = ImGui::GetIO();
    const bool reads = choice.on && !io.WantTextInput;
    choice.held = reads && !io.KeyCtrl && !io.KeyAlt && ImGui::IsKeyDown(nativeKey(keyOf('d')));
    choice.inverts = reads && io.KeyCtrl;
    choice.smooths = reads && io.KeyShift && !ImGui::IsKeyDown(nativeKey(keyOf('f')));
    if (!reads)
        return;
    if (keyPressed(keyOf('i')))
        choice.tool = SculptTool::Paint;
    if (ctrlPressed(keyOf('z'), true))
        (io.KeyShift ? choice.redo : choice.undo) = true;
    if (ctrlPressed(keyOf('y'), true))
        choice.redo = true;
    if (ImGui::IsKeyDown(nativeKey(keyOf('f'))) && !io.KeyCtrl && !io.KeyAlt) {
        // The pointer to the right: larger.
        const auto grown = std::exp(0.006 * static_cast<double>(io.MouseDelta.x));
        double& value = io.KeyShift ? choice.strength : choice.radius;
        value = io.KeyShift ? std::clamp(value * grown, 0.01, 1.0)
                            : std::clamp(value * grown, kMinSculptRadius, kMaxSculptRadius);
    }
}

void drawSculpt(const PanelInput& input, PanelState& state, Widgets& widgets) {
    SculptChoice& choice = state.sculpt;
    (void)widgets.check("sculpt", "Sculpt (B)", choice.on);
    if (!choice.on)
        return;
    if (!input.sculpt.possible) {
        widgets.wrapped(
            "Nothing here is felt as a field. Open a volume, or choose in the material editor that "
            "the material is felt as a field.",
            ImGui::GetColorU32(ImGuiCol_TextDisabled));
        return;
    }
    shelf(choice, widgets);
    if (const SculptTool tool = toolOf(choice); tool == SculptTool::Stamp || tool == SculptTool::Imprint)
        stamps(input.sculpt.stamps, choice, widgets);
    else if (tool == SculptTool::Paint)
        paintColor(choice, widgets);
    sliders(choice, widgets);
    history(input.sculpt, choice, widgets);
}

} // namespace touchstone
