#include "workbench/panels/material_panel.h"

#include "engine/scene/haptic_layers.h"
#include "engine/scene/haptic_numbers.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/presets.h"
#include "workbench/figures/quantity.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/field_row.h"
#include "workbench/panels/notes.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace touchstone {

namespace {

/// The origin of a value that the extension does not state.
const char* originOf(HapticSource source) {
    switch (source) {
    case HapticSource::Mpeg:
        return "MPEG";
    case HapticSource::Physics:
        return "physics";
    case HapticSource::DerivedFromPbr:
        return "derived";
    case HapticSource::Touchstone:
    case HapticSource::Default:
        break;
    }
    return "default";
}

const HapticMaterial::Field<float>* settledField(const HapticMaterial& haptic, std::string_view name) {
    const HapticNumber* number = findHapticNumber(name);
    return number != nullptr && number->settled != nullptr ? &(haptic.*number->settled) : nullptr;
}

class MaterialPanel {
  public:
    MaterialPanel(const MaterialPanelInput& input, MaterialController& controller, MaterialPanelState& state,
                  Widgets& widgets)
        : in_(input), controller_(controller), edits_(controller.edits()), state_(state), widgets_(widgets),
          m_(state.material), now_(edits_.now(m_)), was_(edits_.inFile(m_)) {
        // Effective values with the statement as shown; the scene's copy may be a few frames old.
        HapticLayers says = materialOf(m_).says;
        says.ours = now_;
        haptic_ = settledHaptics(says, in_.scene->images);
    }

    void draw() {
        chooser();
        preset();
        // The fields scroll; the buttons stay visible at any window height.
        ImGui::BeginChild("fields", ImVec2(0.0f, -std::max(1.0f, state_.footer)));
        fields();
        ImGui::EndChild();
        const float begin = ImGui::GetCursorPosY();
        history();
        saving();
        state_.footer = ImGui::GetCursorPosY() - begin;
    }

  private:
    void fields() {
        if (!now_.shader.is_null())
            drawProgram(m_, controller_, state_.program, widgets_);
        for (const NumberField& field : numberFields())
            if (field.name.find('.') == std::string_view::npos && !ofField(field))
                number(field);
        for (const MapField& field : mapFields())
            map(field);
        for (const ChoiceField& field : choiceFields())
            choice(field);
        for (const NumberField& field : numberFields())
            if (ofField(field) && (now_.implicit.value_or(false) || field.get(now_)))
                number(field);
    }

    /// Of a distance field alone.
    static bool ofField(const NumberField& field) {
        const HapticNumber* const number = findHapticNumber(field.name);
        return number != nullptr && number->settled == nullptr;
    }

    /// The first material of the scene that is the file's material `index`.
    [[nodiscard]] const Material& materialOf(size_t index) const { return in_.scene->materials[index]; }

    [[nodiscard]] std::string nameOf(size_t index) const {
        const std::string& name = materialOf(index).name;
        return std::to_string(index) + "  " + (name.empty() ? "unnamed" : name);
    }

    /// The file's material under the probe; -1: none.
    [[nodiscard]] int probed() const {
        return in_.probed >= 0 ? in_.scene->materials[static_cast<size_t>(in_.probed)].fileIndex : -1;
    }

    void chooser() {
        ImGui::PushItemWidth(-1.0f);
        const std::string shown = nameOf(m_) + (edits_.edited(m_) ? " *" : "");
        if (ImGui::BeginCombo("##material", shown.c_str())) {
            for (size_t m = 0; m < edits_.size(); ++m) {
                const std::string text = nameOf(m) + (edits_.edited(m) ? " *" : "") +
                                         (probed() == static_cast<int>(m) ? "   (under the probe)" : "") +
                                         "##" + std::to_string(m);
                if (ImGui::Selectable(text.c_str(), m == m_)) {
                    state_.material = m;
                    state_.followProbe = false;
                }
            }
            ImGui::EndCombo();
        }
        widgets_.mark("edit.material");
        ImGui::PopItemWidth();
        ImGui::Checkbox("follow the probe", &state_.followProbe);
        widgets_.mark("followProbe");
        if (probed() == static_cast<int>(m_)) {
            ImGui::SameLine();
            ImGui::TextDisabled("touched now");
        } else if (in_.probed >= 0 && probed() < 0) {
            widgets_.wrapped("What is touched has no material in the file.",
                             ImGui::GetColorU32(ImGuiCol_TextDisabled));
        }
    }

    void preset() {
        const MaterialPreset* current = presetOf(now_);
        ImGui::PushItemWidth(-1.0f);
        const std::string shown = current != nullptr ? "preset: " + std::string(current->name) : "preset ...";
        if (ImGui::BeginCombo("##preset", shown.c_str())) {
            for (const MaterialPreset& each : materialPresets()) {
                if (ImGui::Selectable(std::string(each.name).c_str(), &each == current)) {
                    change(withPreset(now_, each), "preset " + std::string(each.name));
                    edits_.endGesture();
                }
                widgets_.mark(("preset." + std::string(each.name)).c_str());
            }
            ImGui::EndCombo();
        }
        widgets_.mark("edit.preset");
        ImGui::PopItemWidth();
        ImGui::Spacing();
    }

    void label(std::string_view text, bool stated, bool edited, std::string_view meaning) {
        beginField(widgets_, text, {.stated = stated, .edited = edited}, meaning);
    }

    /// Ends the row; its button takes the field out of the extension.
    void reset(std::string_view name, bool stated) {
        if (!endField(widgets_, name, stated))
            return;
        HapticStatement next = now_;
        resetHapticField(next, name);
        change(std::move(next), "reset " + std::string(name));
        edits_.endGesture();
    }

    void number(const NumberField& field) {
        const std::string id(field.name);
        const std::optional<float> stated = field.get(now_);
        const HapticMaterial::Field<float>* settled = settledField(haptic_, field.name);
        float value = stated.value_or(0.0f);
        std::string origin;
        if (!stated && settled != nullptr) {
            value =
                settled->value.value_or(field.name == "stiffness" ? static_cast<float>(in_.deviceStiffness)
                                        : field.name == "normalTextureInfluence" ? 1.0f
                                                                                 : 0.0f);
            origin = field.name == "stiffness" && !settled->value ? "device" : originOf(settled->source);
        }
        const size_t dot = field.name.find('.');
        const std::string shown = (dot == std::string_view::npos ? "" : "   ") + std::string(field.label);
        label(shown, stated.has_value(), stated != field.get(was_), field.meaning);
        if (widgets_.slider(("edit." + id).c_str(), origin.c_str(), value,
                            {.low = field.low, .high = field.high, .logarithmic = field.logarithmic},
                            quantity(static_cast<double>(value), field.unit))) {
            HapticStatement next = now_;
            if (field.set(next, std::clamp(value, field.least, field.most)))
                change(std::move(next), std::string(field.label));
        }
        reset(field.name, stated.has_value() && dot == std::string_view::npos);
    }

    [[nodiscard]] std::string textureName(size_t index) const {
        const SceneTexture& texture = in_.scene->textures[index];
        std::string name = texture.name;
        if (name.empty() && texture.reference)
            name = in_.scene->images[static_cast<size_t>(texture.reference.image)].name;
        return std::to_string(index) + "  " + name.substr(0, 60);
    }

    void map(const MapField& field) {
        const TextureRef* const current = field.get(now_);
        const TextureRef* const before = field.get(was_);
        if (in_.scene->textures.empty() && current == nullptr)
            return;
        const bool edited = (current == nullptr) != (before == nullptr) ||
                            (current != nullptr && current->texture != before->texture);
        label(field.label, current != nullptr, edited, field.meaning);
        const std::string id(field.name);
        const std::string shown = current != nullptr && current->texture >= 0
                                      ? textureName(static_cast<size_t>(current->texture))
                                      : "none";
        if (ImGui::BeginCombo(("##" + id).c_str(), shown.c_str())) {
            if (ImGui::Selectable("none", current == nullptr))
                chooseMap(field, {});
            for (size_t t = 0; t < in_.scene->textures.size(); ++t)
                if (const TextureRef& texture = in_.scene->textures[t].reference;
                    texture && ImGui::Selectable(textureName(t).c_str(),
                                                 current != nullptr && current->texture == texture.texture))
                    chooseMap(field, texture);
            ImGui::EndCombo();
        }
        widgets_.mark(("edit." + id).c_str());
        reset(field.name, current != nullptr);
        if (field.get(now_) != nullptr)
            for (const NumberField& part : numberFields())
                if (part.name.starts_with(id + "."))
                    number(part);
    }

    void chooseMap(const MapField& field, const TextureRef& texture) {
        HapticStatement next = now_;
        field.set(next, texture);
        change(std::move(next), std::string(field.label));
        edits_.endGesture();
    }

    void choice(const ChoiceField& field) {
        const std::optional<size_t> stated = field.get(now_);
        label(field.label, stated.has_value(), stated != field.get(was_), field.meaning);
        const std::string id(field.name);
        const std::string shown =
            std::string(field.choices[stated.value_or(field.unset)]) + (stated ? "" : "  default");
        if (ImGui::BeginCombo(("##" + id).c_str(), shown.c_str())) {
            for (size_t c = 0; c < field.choices.size(); ++c)
                if (ImGui::Selectable(std::string(field.choices[c]).c_str(), stated == c)) {
                    HapticStatement next = now_;
                    field.set(next, c);
                    change(std::move(next), std::string(field.label));
                    edits_.endGesture();
                }
            ImGui::EndCombo();
        }
        widgets_.mark(("edit." + id).c_str());
        reset(field.name, stated.has_value());
    }

    bool button(const char* text, const char* name, bool enabled, const std::string& hint) {
        if (!enabled)
            ImGui::BeginDisabled();
        const bool pressed = widgets_.button(name, text, hint);
        if (!enabled)
            ImGui::EndDisabled();
        return pressed && enabled;
    }

    /// The note of a widget, and what it is about now.
    static std::string noteWith(const char* name, const std::string& now) {
        return noteOf(name) + (now.empty() ? "" : ": " + now);
    }

    void history() {
        ImGui::Spacing();
        if (button("Undo", "undo", !edits_.undoName().empty(), noteWith("undo", edits_.undoName())))
            edits_.undo();
        ImGui::SameLine();
        if (button("Redo", "redo", !edits_.redoName().empty(), noteWith("redo", edits_.redoName())))
            edits_.redo();
        ImGui::SameLine();
        const EditedProgram* const program = controller_.programs().of(m_);
        const bool typed = program != nullptr && program->edited();
        if (button("As in the file", "resetMaterial", edits_.edited(m_) || typed, "")) {
            change(controller_.programs().reverted(m_, edits_), "as in the file");
            edits_.endGesture();
        }
    }

    void saving() {
        const bool inPlace = controller_.canSaveInPlace();
        if (button("Save", "save", controller_.edited() && !controller_.saving() && inPlace,
                   inPlace ? noteWith("save", controller_.path().string())
                           : controller_.path().string() + " cannot be replaced: save to a new file"))
            controller_.save();
        ImGui::SameLine();
        if (button("Save as...", "saveAs", !controller_.saving(), ""))
            state_.saveAsPressed = true;
        if (controller_.edited()) {
            ImGui::SameLine();
            ImGui::TextDisabled("not saved");
        }
        if (!controller_.notice().empty()) {
            widgets_.wrapped(controller_.notice(), controller_.failed() ? kFailure : kSuccess);
        }
    }

    void change(HapticStatement next, std::string what) {
        edits_.change(m_, std::move(next), std::move(what));
    }

    const MaterialPanelInput& in_;
    MaterialController& controller_;
    MaterialEdits& edits_;
    MaterialPanelState& state_;
    Widgets& widgets_;
    const size_t m_;
    const HapticStatement now_, was_; // of this frame: copies, since a widget changes the controller's
    HapticMaterial haptic_;
};

} // namespace

void drawMaterialPanel(const MaterialPanelInput& input, MaterialController& controller,
                       MaterialPanelState& state, Widgets& widgets) {
    if (input.scene == nullptr)
        return;
    if (controller.edits().size() == 0) {
        widgets.wrapped("The file has no materials: what it feels like cannot be kept in it.");
        return;
    }
    if (state.followProbe && input.probed >= 0) {
        const int touched = input.scene->materials[static_cast<size_t>(input.probed)].fileIndex;
        if (touched >= 0 && !ImGui::IsAnyItemActive())
            state.material = static_cast<size_t>(touched);
    }
    state.material = std::min(state.material, controller.edits().size() - 1);
    MaterialPanel(input, controller, state, widgets).draw();
    if (!ImGui::IsAnyItemActive())
        controller.edits().endGesture();
}

} // namespace touchstone
