#include "workbench/readings/window_readings.h"

namespace touchstone {

namespace {
constexpr double kChartSeconds = 10.0;
}

WindowReadings::WindowReadings(const ServoLoop& servo, const ServoRecorder& recorder)
    : servo_(servo), recorder_(recorder), liveError_(servo.rateHz()),
      forces_(static_cast<size_t>(kChartSeconds * servo.rateHz())) {}

void WindowReadings::sceneOffered(const OfferedScene& scene) {
    if (compared_ == scene.number)
        return;
    compared_ = scene.number;
    liveError_.sceneOffered(scene.number, scene.haptic, scene.source);
}

void WindowReadings::take(const TickRecord& record, const HapticSettings& settings) {
    if (record.hand > 0)
        return;
    view_.add(record);
    forces_.add(record, recorder_.recording());
    liveError_.take(record, settings);
}

void WindowReadings::flush(double now) {
    liveError_.flush();
    view_.renew(servo_, liveError_, now);
}

} // namespace touchstone
