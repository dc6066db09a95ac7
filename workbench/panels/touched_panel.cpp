#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "workbench/figures/texture_figures.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"
#include "workbench/readings/active_effects.h"
#include "workbench/readings/failing_program.h"

#include <imgui.h>

#include <cmath>
#include <string>
#include <vector>

namespace touchstone {

namespace {

/// Scene material under the probe; in the air the only one of the scene, else -1.
int touchedMaterial(const PanelInput& input) {
    const auto& objects = input.haptic->objects;
    const int object = input.tick->output.object;
    if (object >= 0 && static_cast<size_t>(object) < objects.size())
        return objects[static_cast<size_t>(object)]->material;
    return objects.size() == 1 ? objects.front()->material : -1;
}

void row(const Widgets& widgets, const char* label, const char* format, double a, double b = 0.0) {
    ImGui::TextDisabled("%s", label);
    ImGui::SameLine(widgets.units(90.0f));
    ImGui::Text(format, a, b);
}

void figures(const HapticMaterialData& material, const Widgets& widgets) {
    if (std::isnan(material.stiffness))
        row(widgets, "stiffness", "the device's", 0.0);
    else
        row(widgets, "stiffness", "%.0f N/m", material.stiffness);
    if (material.damping > 0.0)
        row(widgets, "damping", "%.2f N s/m", material.damping);
    row(widgets, "friction", "%.2f, sliding %.2f", material.staticFriction, material.dynamicFriction);
    if (material.viscousFriction > 0.0)
        row(widgets, "viscous", "%.2f N s/m", material.viscousFriction);
}

/// Of the touched object; in the air of each one of the material.
void coverage(const PanelInput& input, int material, Widgets& widgets) {
    const int touched = input.tick->output.object;
    for (const Coverage& each : coverageOf(*input.haptic, input.textures)) {
        const HapticObject& object = *input.haptic->objects[static_cast<size_t>(each.object)];
        if (touched >= 0 ? each.object != touched : object.material != material)
            continue;
        const std::string text = coverageText(each);
        widgets.wrapped(text, ImGui::GetColorU32(ImGuiCol_Text));
        widgets.mark("coverage", text);
    }
}

/// Why the program of the material has no result where it is touched.
void programFault(const PanelInput& input, const HapticMaterialData& material, Widgets& widgets) {
    if (input.failing == nullptr || input.failing->program() == nullptr ||
        input.failing->program() != material.program.get())
        return;
    const std::string text = input.failing->program()->name + ": " + program::textOf(input.failing->fault()) +
                             "; the surface is plain";
    widgets.wrapped(text, kFailure);
    widgets.mark("programFault", text);
}

/// Effects with their reasons beneath; reasons of those that the scene does not call for as tooltips.
void effects(const std::vector<ActiveEffect>& effects, Widgets& widgets) {
    using State = ActiveEffect::State;
    for (const ActiveEffect& effect : effects) {
        const ImVec4 color = effect.state == State::On ? ImVec4(0.45f, 0.82f, 0.55f, 1.0f)
                             : effect.state == State::SwitchedOff
                                 ? ImVec4(0.96f, 0.72f, 0.30f, 1.0f)
                                 : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled);
        ImGui::TextColored(color, "%s: %s", effect.state == State::On ? "on" : "off",
                           effectName(effect.effect));
        widgets.mark((std::string("effect:") + effectName(effect.effect)).c_str(), effect.reason);
        if (effect.state != State::Absent)
            widgets.wrapped(effect.reason, ImGui::GetColorU32(ImGuiCol_TextDisabled));
    }
}

} // namespace

void drawTouched(const PanelInput& input, PanelState& state, Widgets& widgets) {
    if (input.haptic == nullptr)
        return;
    if (ImGui::Button("Edit materials (E)"))
        state.editMaterials = !state.editMaterials;
    widgets.mark("editMaterials");
    const int index = touchedMaterial(input);
    const auto at = static_cast<size_t>(index);
    if (index < 0 || at >= input.haptic->materials.size() || at >= input.scene->materials.size()) {
        ImGui::TextDisabled("touch something to see what it is");
        return;
    }
    const std::string& name = input.scene->materials[at].name;
    ImGui::TextUnformatted(name.empty() ? "without a name" : name.c_str());
    widgets.mark("material");
    figures(input.haptic->materials[at], widgets);
    coverage(input, index, widgets);
    programFault(input, input.haptic->materials[at], widgets);
    effects(activeEffects(input.haptic->plan, index, state.settings), widgets);
}

} // namespace touchstone
