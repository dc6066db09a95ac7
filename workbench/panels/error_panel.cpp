#include "workbench/panels/error_panel.h"

#include "study/errors/noticeable.h"

#include <imgui.h>

#include <cstdio>
#include <string_view>

namespace touchstone {

namespace {

using study::LiveErrorFigures;

constexpr double kDegree = 0.017453292519943295;

ImVec4 colorOf(Perception perception) {
    return perception == Perception::Below   ? ImVec4(0.45f, 0.82f, 0.55f, 1.0f)
           : perception == Perception::Above ? ImVec4(0.96f, 0.72f, 0.30f, 1.0f)
                                             : ImGui::GetStyleColorVec4(ImGuiCol_Text);
}

struct Noticeable {
    double direction = 0.0, share = 0.0, force = 0.0; ///< rad, 1, N
};

const Noticeable& noticeable() {
    static const Noticeable kFound = [] {
        Noticeable found;
        for (const study::JustNoticeable& just : study::noticeableDifferences()) {
            if (just.quantity == "force direction")
                found.direction = just.value;
            if (just.quantity == "force magnitude")
                found.share = just.value;
            if (just.quantity == "force")
                found.force = just.value;
        }
        return found;
    }();
    return kFound;
}

/// `just`: the just-noticeable difference; 0: unknown.
void row(const char* name, const LiveErrorFigures::Pair& error, double unit, double just,
         Perception perception) {
    constexpr const char* format = "%.2f";
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    ImGui::Text(format, error.p50 / unit);
    ImGui::TableNextColumn();
    ImGui::TextColored(colorOf(perception), format, error.p99 / unit);
    ImGui::TableNextColumn();
    if (just > 0.0)
        ImGui::TextDisabled("%.3g", just / unit);
    else
        ImGui::TextDisabled("-");
}

void table(const LiveErrorFigures& error) {
    if (!ImGui::BeginTable("error", 4, ImGuiTableFlags_SizingStretchProp))
        return;
    ImGui::TableSetupColumn("", 0, 2.1f);
    for (const char* name : {"p50", "p99", "noticed"})
        ImGui::TableSetupColumn(name, 0, 1.1f);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TableNextRow();
    for (const char* title : {"", "p50", "p99", "noticed"}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(title);
        if (std::string_view(title) == "noticed" && ImGui::IsItemHovered())
            ImGui::SetTooltip("From what on people notice it (docs/accuracy.md):\n%s",
                              "forces one after the other, on a moving arm");
    }
    ImGui::PopStyleColor();
    const Noticeable& just = noticeable();
    const ErrorPerception perceived = errorPerception(error);
    row("place, µm", error.position, 1e-6, 0.0, Perception::Undecided);
    row("force, mN", error.force, 1e-3, just.force, perceived.force);
    row("force, %", error.forceShare, 1e-2, just.share, perceived.forceShare);
    row("direction, °", error.direction, kDegree, just.direction, perceived.direction);
    ImGui::EndTable();
}

} // namespace

bool ErrorPerception::below() const {
    const auto above = [](Perception p) { return p == Perception::Above; };
    return !above(force) && !above(forceShare) && !above(direction) && !above(contact);
}

ErrorPerception errorPerception(const LiveErrorFigures& error) {
    const Noticeable& just = noticeable();
    const bool absolute = error.force.p99 <= just.force, relative = error.forceShare.p99 <= just.share;
    // Either threshold is enough; the figure that exceeds its own decides nothing then.
    const Perception other = absolute || relative ? Perception::Undecided : Perception::Above;
    const auto of = [](bool below) { return below ? Perception::Below : Perception::Above; };
    return {.force = absolute ? Perception::Below : other,
            .forceShare = relative ? Perception::Below : other,
            .direction = of(error.direction.p99 <= just.direction),
            .contact = of(error.lost + error.invented == 0)};
}

void drawError(const LiveErrorFigures& error, Widgets& widgets) {
    table(error);
    widgets.mark("error");
    if (error.inContact + error.lost + error.invented == 0) {
        ImGui::TextDisabled("in contact: touch something");
        return;
    }
    const ErrorPerception perceived = errorPerception(error);
    const bool below = perceived.below();
    ImGui::TextColored(colorOf(below ? Perception::Below : Perception::Above), "%s",
                       below ? "below perception" : "may be felt");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "The last 2 s against the most exact configurations, run beside the servo on the same hand.\n"
            "Below: 99 of 100 ticks differ by less than people notice, and none in contact. Of the force\n"
            "either its absolute or its relative threshold has to hold.");
    if (perceived.contact == Perception::Above)
        ImGui::TextColored(colorOf(Perception::Above), "contact lost in %llu ticks, invented in %llu",
                           static_cast<unsigned long long>(error.lost),
                           static_cast<unsigned long long>(error.invented));
    if (error.comparedShare < 0.995)
        ImGui::TextDisabled("%.0f %% of the ticks compared", 100.0 * error.comparedShare);
}

} // namespace touchstone
