#include "workbench/figures/quantity.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"
#include "workbench/readings/force_parts.h"
#include "workbench/timeline/timeline_controller.h"

#include <imgui.h>

#include <string>

namespace touchstone {

namespace {

constexpr ImU32 kGrey = IM_COL32(120, 126, 133, 255);

} // namespace

TouchLamp touchLamp(const PanelInput& input, const PanelState& state) {
    if (input.timeline->looking() && !input.timeline->again().running())
        return input.tick->output.contacts > 0 ? TouchLamp{"Recorded: touching", kAmber}
                                               : TouchLamp{"Recorded: in the air", kGrey};
    const HapticOutput& tick = input.servo->last.output;
    if (input.scene == nullptr)
        return {input.loading ? "Loading" : "Nothing to touch yet", kGrey};
    if (has(tick.flags, TickFlag::SafetyLatched))
        return {"Force off after a fault: press space twice", kRed};
    if (!state.settings.forceEnabled)
        return {"Force off (space)", kAmber};
    if (input.timeline->looking())
        return {"Touched again, force off", kAmber};
    if (has(tick.flags, TickFlag::StartedInside))
        return {"Inside or too near: move out to touch", kAmber};
    if (has(tick.flags, TickFlag::InputInvalid))
        return {"No hand", kGrey};
    const double coupling = input.servo->last.sample.mapping.coupling;
    const bool mouse = state.device.empty() && !state.simulatedHand; // no clutch, but hovers
    if (coupling < 1.0 && !mouse)
        return {coupling > 0.0 ? "Clutch: the force fades" : "Clutched: the hand stays here", kAmber};
    if (has(tick.flags, TickFlag::ForceRamping) && tick.contacts > 0 && coupling == 1.0)
        return {"Force fades in", kAmber};
    return tick.contacts > 0 ? TouchLamp{"Touching", kGreen} : TouchLamp{"In the air", kGrey};
}

namespace {

/// Before a line of text.
void drawDot(ImU32 color) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight(), radius = 0.32f * line;
    ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + radius, at.y + 0.5f * line), radius, color);
    ImGui::Dummy(ImVec2(2.0f * radius, line));
    ImGui::SameLine();
}

/// A line for each hand beside the first: its lamp, its name, what it feels and what its device gets.
void drawOthers(const PanelInput& input, const PanelState& state, Widgets& widgets) {
    for (size_t i = 0; i < input.others.size(); ++i) {
        const OtherHands::State& other = input.others[i];
        const HapticOutput& tick = other.tick.output;
        const bool absent = has(tick.flags, TickFlag::InputInvalid) || !other.tick.sample.valid;
        const bool latched = has(tick.flags, TickFlag::SafetyLatched);
        const bool off = latched || !state.settings.forceEnabled;
        const ImU32 color = latched             ? kRed
                            : off               ? kAmber
                            : absent            ? kGrey
                            : tick.contacts > 0 ? kGreen
                                                : kGrey;
        drawDot(color);
        const std::string where = other.status.empty() ? other.name : other.name + ", " + other.status;
        const std::string felt = absent ? "none"
                                        : quantity(glm::length(tick.force), "N") + ", " +
                                              quantity(glm::length(tick.command.force()), "N") + " sent";
        widgets.wrapped("Hand " + std::to_string(i + 2) + " (" + where + "): " + felt);
        widgets.mark(("hand" + std::to_string(i + 2)).c_str());
    }
}

} // namespace

void drawNow(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const TouchLamp lamp = touchLamp(input, state);
    drawDot(lamp.color);
    ImGui::TextUnformatted(lamp.text);
    widgets.mark("lamp");

    const HapticOutput& tick = input.tick->output;
    ImGui::PushFont(ImGui::GetIO().Fonts->Fonts.back());
    const bool unsent = !input.forceSent && tick.contacts > 0;
    ImGui::TextColored(ImGui::GetStyleColorVec4(unsent ? ImGuiCol_TextDisabled : ImGuiCol_Text), "%.2f N",
                       glm::length(tick.force));
    ImGui::PopFont();
    widgets.mark("force");
    ImGui::SameLine(widgets.units(110.0f));
    ImGui::BeginGroup();
    ImGui::TextDisabled("%.2f mm deep", 1e3 * tick.penetration);
    // A recorded tick that cannot be recomputed has no normal.
    if (tick.contacts > 0 && surfaceNormal(tick) == glm::dvec3(0.0))
        ImGui::TextDisabled("its direction is not recorded");
    else
        ImGui::TextDisabled("%.2f N along the surface", forceParts(tick).tangential);
    // Always there, so that nothing below it moves when the force is switched.
    ImGui::TextColored(unsent ? ImColor(kAmber) : ImColor(ImGui::GetColorU32(ImGuiCol_TextDisabled)),
                       "%.2f N sent to the device", glm::length(tick.command.force()));
    widgets.mark("sent");
    ImGui::EndGroup();

    drawOthers(input, state, widgets);
    PassivityMode& passivity = state.settings.passivity;
    bool controlled = passivity == PassivityMode::Control;
    if (widgets.check("passivity", "Passivity control", controlled))
        passivity = controlled ? PassivityMode::Control : PassivityMode::Observe;
    ImGui::SameLine();
    if (passivity != PassivityMode::Off)
        ImGui::TextDisabled("%+.2f mJ", 1e3 * tick.energyBalance);
}

} // namespace touchstone
