#include "workbench/figures/time_histogram.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

namespace touchstone {

namespace {

void row(const Widgets& widgets, const char* label, const char* format, double a, double b = 0.0) {
    ImGui::TextDisabled("%s", label);
    ImGui::SameLine(widgets.units(100.0f));
    ImGui::Text(format, a, b);
}

} // namespace

void drawServo(const PanelInput& input, Widgets& widgets) {
    const ServoView& servo = *input.servo;
    row(widgets, "rate", "%.0f Hz of %.0f", servo.ticksPerSecond, servo.rateHz);
    row(widgets, "missed", "%.0f of %.0f", static_cast<double>(servo.counters.missed),
        static_cast<double>(servo.counters.ticks));
    row(widgets, "step", "%.1f µs, p99 %.1f µs", servo.stepP50Us, servo.stepP99Us);
    if (ImGui::IsItemHovered())
        showTimeHistogram("Time of a step, up to µs (log of ticks)", "last 4 s", servo.stepHistogram,
                          widgets.units(1.0f));
    row(widgets, "wake-up", "%.1f µs, p99 %.1f µs", servo.wakeP50Us, servo.wakeP99Us);
    if (ImGui::IsItemHovered())
        showTimeHistogram("Wake-up after the deadline, up to µs (log of ticks)", servo.scheduling.c_str(),
                          servo.wakeHistogram, widgets.units(1.0f));
    if (servo.stolenShare && *servo.stolenShare > 0.0005)
        row(widgets, "stolen", "%.1f %% of a processor", 100.0 * *servo.stolenShare);
    row(widgets, "picture", "%.0f frames/s", input.framesPerSecond);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%d x %d on %s", input.sceneSize.x, input.sceneSize.y, input.gpuName.c_str());
}

} // namespace touchstone
