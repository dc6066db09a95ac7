#pragma once

#include "haptics/recording/servo_recorder.h"
#include "session/tick_subscriber.h"
#include "study/live/live_error.h"
#include "workbench/readings/force_history.h"
#include "workbench/readings/servo_view.h"

namespace touchstone {

/// What the window shows of the ticks of hand 0: charts, the servo's figures and the live error. Main thread.
class WindowReadings final : public TickSubscriber {
  public:
    /// Both outlive it. `recorder` tells which ticks are recorded.
    WindowReadings(const ServoLoop& servo, const ServoRecorder& recorder);

    void sceneOffered(const OfferedScene& scene) override;
    void take(const TickRecord& record, const HapticSettings& settings) override;
    void flush(double now) override;

    [[nodiscard]] const ServoView& servo() const { return view_; }
    [[nodiscard]] const ForceHistory& forces() const { return forces_; }
    void clearForces() { forces_.clear(); }

  private:
    const ServoLoop& servo_;
    const ServoRecorder& recorder_;
    study::LiveError liveError_;
    ServoView view_;
    ForceHistory forces_;
    uint32_t compared_ = 0; // scene of liveError_
};

} // namespace touchstone
