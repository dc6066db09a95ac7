#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <cmath>

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

/// Active effects with their reasons beneath; reasons of inactive ones as tooltips.
void effects(const EffectPlan& plan, int material, const Widgets& widgets) {
    for (const bool on : {true, false})
        for (const PlannedEffect& effect : plan.effects) {
            if (effect.material != material || effect.on != on)
                continue;
            ImGui::TextColored(on ? ImVec4(0.45f, 0.82f, 0.55f, 1.0f)
                                  : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled),
                               "%s: %s", on ? "on" : "off", effectName(effect.effect));
            if (!on && ImGui::IsItemHovered())
                ImGui::SetTooltip("%s", effect.reason.c_str());
            if (!on)
                continue;
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
    effects(input.haptic->plan, index, widgets);
}

} // namespace touchstone
