#include "workbench/figures/quantity.h"
#include "workbench/figures/time_histogram.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <string>
#include <string_view>

namespace touchstone {

namespace {

void row(Widgets& widgets, const char* label, const char* name, const std::string& text,
         std::string_view note = {}) {
    ImGui::TextDisabled("%s", label);
    ImGui::SameLine(widgets.units(100.0f));
    ImGui::TextUnformatted(text.c_str());
    if (*name != '\0')
        widgets.mark(name, note);
}

std::string times(double p50Us, double p99Us) {
    return quantity(1e-6 * p50Us, "s") + ", p99 " + quantity(1e-6 * p99Us, "s");
}

} // namespace

void drawServo(const PanelInput& input, Widgets& widgets) {
    const ServoView& servo = *input.servo;
    row(widgets, "rate", "servoRate", figure(servo.ticksPerSecond, 4) + " Hz of " + figure(servo.rateHz, 4));
    row(widgets, "missed", "servoMissed",
        figure(static_cast<double>(servo.counters.missed), 1) + " of " +
            figure(static_cast<double>(servo.counters.ticks), 1));
    row(widgets, "step", "", "median " + times(servo.stepP50Us, servo.stepP99Us));
    if (ImGui::IsItemHovered())
        showTimeHistogram("Time of a step, up to µs (log of ticks)", "last 4 s", servo.stepHistogram,
                          widgets.units(1.0f));
    row(widgets, "wake-up", "", "median " + times(servo.wakeP50Us, servo.wakeP99Us));
    if (ImGui::IsItemHovered())
        showTimeHistogram("Wake-up after the deadline, up to µs (log of ticks)", servo.scheduling.c_str(),
                          servo.wakeHistogram, widgets.units(1.0f));
    if (servo.stolenShare && *servo.stolenShare > 0.0005)
        row(widgets, "stolen", "servoStolen", figure(100.0 * *servo.stolenShare, 2) + " % of a processor");
    row(widgets, "picture", "servoPicture", figure(input.framesPerSecond, 2) + " frames/s",
        std::to_string(input.sceneSize.x) + " x " + std::to_string(input.sceneSize.y) + " on " +
            input.gpuName);
}

} // namespace touchstone
