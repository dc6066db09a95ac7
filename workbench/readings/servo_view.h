#pragma once

#include "haptics/servo/servo_loop.h"
#include "study/live/live_error.h"
#include "workbench/figures/stolen_time.h"
#include "workbench/figures/tick_statistics.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// The servo's figures for display: percentiles over the last seconds, updated twice a second. Main thread.
class ServoView {
  public:
    void add(const TickRecord& record) {
        statistics_.addLive(record);
        last = record;
    }
    /// After each batch. `now`: s, any steady clock.
    void renew(const ServoLoop& servo, const study::LiveError& liveError, double now);

    ServoLoop::Counters counters;
    TickRecord last;
    std::string scheduling;
    double rateHz = 0.0;
    double ticksPerSecond = 0.0;
    double wakeP50Us = 0.0, wakeP99Us = 0.0;
    double stepP50Us = 0.0, stepP99Us = 0.0;
    std::array<double, kStageCount> stageP50Us{}, stageP99Us{}; ///< over the ticks in contact
    double contactP50Us = 0.0, contactP99Us = 0.0;              ///< of their whole step
    study::LiveErrorFigures error;
    std::vector<uint64_t> wakeHistogram, stepHistogram; ///< by kHistogramEndsUs
    /// Fraction of one processor that the host took away since the last update; nullopt where unknown.
    std::optional<double> stolenShare;

  private:
    static constexpr size_t kWindow = 4000; // ticks
    static constexpr double kRenewal = 0.5; // s

    TickStatistics statistics_{kWindow};
    double lastRenewal_ = -1.0;
    StolenTime stolen_;
    double stolenThen_ = 0.0;
    uint64_t ticksThen_ = 0;
};

} // namespace touchstone
