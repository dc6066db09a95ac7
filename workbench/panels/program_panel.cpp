#include "workbench/panels/program_panel.h"

#include "workbench/editor/haptic_fields.h"
#include "workbench/figures/quantity.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/field_row.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace touchstone {

namespace {

constexpr std::array kComponents{"x", "y", "z", "w"};

/// Above this ratio of its ends a slider of equal steps has no room for what is small.
constexpr double kWideRange = 100.0;

SliderRange rangeOf(const ProgramParameter& parameter) {
    return {.low = static_cast<float>(parameter.least),
            .high = static_cast<float>(parameter.greatest),
            .logarithmic = parameter.kind == ProgramParameter::Kind::Float && parameter.least > 0.0 &&
                           parameter.greatest >= kWideRange * parameter.least,
            .clamp = true};
}

/// "rings per metre\n1 to 2,000 1/m, by default 200\n`touchstone edit --field shader.ringscale=VALUE`".
std::string noteOf(const ProgramParameter& parameter) {
    std::string normal;
    for (size_t i = 0; i < parameter.components; ++i)
        normal += (i > 0 ? ", " : "") + figure(parameter.value[i]);
    return (parameter.text.empty() ? parameter.name : parameter.text) + "\n" + figure(parameter.least) +
           " to " + figure(parameter.greatest) + (parameter.unit.empty() ? "" : " " + parameter.unit) +
           ", by default " + normal + "\n`touchstone edit --field shader." + parameter.name +
           (parameter.components > 1 ? "=VALUE,..." : "=VALUE") + "`";
}

bool states(const HapticStatement& statement, const std::string& name) {
    const nlohmann::json& shader = statement.shader;
    return shader.is_object() && shader.contains("parameters") && shader["parameters"].contains(name);
}

nlohmann::json valueIn(const HapticStatement& statement, const std::string& name) {
    const nlohmann::json& shader = statement.shader;
    return states(statement, name) ? shader["parameters"][name] : nlohmann::json();
}

/// Those of the statement, else the defaults; none where they are wrong, and the surface is plain.
std::vector<std::array<double, 4>> valuesOf(const HapticStatement& statement) {
    try {
        return materialProgram(statement.program, statement.shader).values;
    } catch (const std::exception&) {
        return {};
    }
}

class ProgramRows {
  public:
    ProgramRows(size_t material, MaterialEdits& edits, Widgets& widgets)
        : m_(material), edits_(edits), widgets_(widgets), now_(edits.now(material)) {}

    void draw() {
        const std::vector<ProgramParameter>& parameters = now_.program->source.parameters;
        const std::vector<std::array<double, 4>> values = valuesOf(now_);
        for (size_t i = 0; i < values.size(); ++i)
            for (size_t k = 0; k < parameters[i].components; ++k)
                row(parameters[i], values[i], k);
    }

  private:
    void row(const ProgramParameter& parameter, std::array<double, 4> value, size_t component) {
        const bool stated = states(now_, parameter.name);
        const bool edited = valueIn(now_, parameter.name) != valueIn(edits_.inFile(m_), parameter.name);
        const bool first = component == 0, many = parameter.components > 1;
        const std::string field = "shader." + parameter.name, note = noteOf(parameter);
        beginField(widgets_, first ? parameter.name : "", {.stated = stated, .edited = edited}, note);
        auto chosen = static_cast<float>(value[component]);
        const std::string name = "edit." + field + (many ? "." + std::string(kComponents[component]) : "");
        if (widgets_.slider(name.c_str(), many ? kComponents[component] : "", chosen, rangeOf(parameter),
                            quantity(value[component], parameter.unit), note)) {
            const auto exact = static_cast<double>(chosen);
            value[component] =
                std::clamp(parameter.kind == ProgramParameter::Kind::Float ? exact : std::round(exact),
                           parameter.least, parameter.greatest);
            HapticStatement next = now_;
            next.shader = KeptJson(withParameter(now_.shader, parameter, value));
            edits_.change(m_, std::move(next), parameter.name);
        }
        if (endField(widgets_, field, stated && first)) {
            HapticStatement next = now_;
            resetHapticField(next, field);
            edits_.change(m_, std::move(next), "reset " + field);
            edits_.endGesture();
        }
    }

    const size_t m_;
    MaterialEdits& edits_;
    Widgets& widgets_;
    const HapticStatement now_; ///< of this frame
};

} // namespace

std::string costText(const ProgramCost& cost) {
    if (cost.instructions == 0)
        return "its cost is being measured";
    return figure(static_cast<double>(cost.instructions)) + " instructions, " + figure(cost.ns) +
           " ns a tick, " + figure(cost.nsWithGradients) + " ns with gradients";
}

std::string problemText(const EditedProgram& program) {
    if (program.problem.empty())
        return {};
    return (program.line > 0 ? "line " + std::to_string(program.line) + ": " : "") + program.problem;
}

void drawProgram(size_t material, MaterialController& controller, ProgramPanelState& state,
                 Widgets& widgets) {
    MaterialEdits& edits = controller.edits();
    const HapticStatement now = edits.now(material);
    const EditedProgram* const program = controller.programs().of(material);
    const bool edited = now.shader != edits.inFile(material).shader;
    beginField(widgets, "program", {.stated = true, .edited = edited},
               "haptic program: what a touched place feels and looks like (docs/programs.md)");
    const float x = ImGui::GetCursorPosX();
    const float room = ImGui::CalcItemWidth() - (program != nullptr ? Widgets::buttonWidth("Edit") : 0.0f);
    ImGui::TextUnformatted(
        shortened(program != nullptr ? program->name : "cannot be read", room - widgets.units(8.0f)).c_str());
    if (program != nullptr) {
        ImGui::SameLine(x + room);
        if (widgets.button("program.edit", "Edit")) {
            state.source = controller.programs().indexOf(material);
            state.open = true;
        }
    }
    if (endField(widgets, "shader", true)) {
        HapticStatement next = now;
        resetHapticField(next, "shader");
        edits.change(material, std::move(next), "reset shader");
        edits.endGesture();
    }
    if (program == nullptr)
        return;
    if (program->program != nullptr) {
        controller.programs().measure(controller.programs().indexOf(material));
        widgets.wrapped(costText(program->cost), ImGui::GetColorU32(ImGuiCol_TextDisabled));
    }
    if (const std::string problem = problemText(*program); !problem.empty())
        widgets.wrapped(problem + (program->program != nullptr ? "; the last good program stays" : ""),
                        kFailure);
    else if (!program->fault.problem.empty())
        widgets.wrapped(program::textOf(program->fault) + "; the surface is plain", kFailure);
    if (now.program != nullptr)
        ProgramRows(material, edits, widgets).draw();
    ImGui::Spacing();
}

} // namespace touchstone
