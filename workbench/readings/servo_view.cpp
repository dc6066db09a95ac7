#include "workbench/readings/servo_view.h"

namespace touchstone {

void ServoView::renew(const ServoLoop& servo, const study::LiveError& liveError, double now) {
    counters = servo.counters();
    if (lastRenewal_ >= 0.0 && now - lastRenewal_ < kRenewal)
        return;
    const std::optional<double> stolen = stolen_.seconds();
    if (stolen && lastRenewal_ >= 0.0)
        stolenShare = (*stolen - stolenThen_) / (now - lastRenewal_);
    stolenThen_ = stolen.value_or(0.0);
    if (lastRenewal_ >= 0.0)
        ticksPerSecond = static_cast<double>(counters.ticks - ticksThen_) / (now - lastRenewal_);
    lastRenewal_ = now;
    ticksThen_ = counters.ticks;
    scheduling = servo.scheduling().policy;
    rateHz = servo.rateHz();
    const auto us = [](int64_t ns) { return static_cast<double>(ns) * 1e-3; };
    wakeP50Us = us(statistics_.wake().percentile(0.5));
    wakeP99Us = us(statistics_.wake().percentile(0.99));
    stepP50Us = us(statistics_.step().percentile(0.5));
    stepP99Us = us(statistics_.step().percentile(0.99));
    for (size_t i = 0; i < kStageCount; ++i) {
        stageP50Us[i] = us(statistics_.stages()[i].percentile(0.5));
        stageP99Us[i] = us(statistics_.stages()[i].percentile(0.99));
    }
    contactP50Us = us(statistics_.stepInContact().percentile(0.5));
    contactP99Us = us(statistics_.stepInContact().percentile(0.99));
    error = liveError.figures();
    wakeHistogram = histogramOf(statistics_.wake());
    stepHistogram = histogramOf(statistics_.step());
}

} // namespace touchstone
