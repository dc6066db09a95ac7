#pragma once

#include "engine/time/samples.h"
#include "haptics/force/work_meter.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/tick/haptic_step.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace touchstone {

/// Statistics of a stream of ticks, for `--json` and the panel. One thread.
class TickStatistics {
  public:
    /// `window`: ticks for the percentiles; 0: all of them.
    explicit TickStatistics(size_t window = 0)
        : wake_(window), period_(window), step_(window), stepInContact_(window) {
        stages_.fill(Samples(window > 0 ? window : kStageWindow));
    }

    /// A tick of the real-time loop, with its wake-up.
    void addLive(const TickRecord& record);
    /// A tick of an offline run.
    void add(const HapticOutput& output, int64_t stepNs);
    /// For a contact tick: distance of the proxy sphere's surface from the mesh, m.
    void addProxyGap(double gap);

    [[nodiscard]] uint64_t ticks() const { return ticks_; }
    [[nodiscard]] uint64_t contactTicks() const { return contactTicks_; }
    [[nodiscard]] const Samples& wake() const { return wake_; }
    [[nodiscard]] const Samples& step() const { return step_; }
    /// ns of each Stage over the live contact ticks, the latest 600,000 of them.
    [[nodiscard]] const std::array<Samples, kStageCount>& stages() const { return stages_; }
    [[nodiscard]] const Samples& stepInContact() const { return stepInContact_; }

    /// {p50_ns, p99_ns, ...} over the contact ticks (over all without any), and the same over `all`.
    [[nodiscard]] nlohmann::ordered_json stepJson() const;
    /// {sample: {mean_ns, p50_ns, p99_ns}, contact: ...} over the live contact ticks: zeros where the servo
    /// did not measure them.
    [[nodiscard]] nlohmann::ordered_json stagesJson() const;
    /// {p50_us, p99_us, p999_us, max_us}: wake-up relative to the deadline; period_p50_us: between wake-ups.
    [[nodiscard]] nlohmann::ordered_json wakeJson() const;
    /// {ticks, share, proxy_on_mesh_share, ...}; the share is null where no gap was measured.
    [[nodiscard]] nlohmann::ordered_json contactJson() const;
    /// {mean_n, max_n} over the contact ticks, stage 7.
    [[nodiscard]] nlohmann::ordered_json forceJson() const;
    /// {given_j, law_j, sampling_j, command_given_j, gaps}: work on the hand over all ticks, see
    /// work_meter.h; gaps: number of times that records were dropped, whose work is missing. balance_j and
    /// most_balance_j: of the passivity observer, see haptics/safety/passivity.h.
    [[nodiscard]] nlohmann::ordered_json energyJson() const;
    /// Ticks by TickFlag.
    [[nodiscard]] nlohmann::ordered_json flagsJson() const;

  private:
    static constexpr size_t kFlagCount = 17;
    static constexpr size_t kStageWindow = 600'000; // ticks: 38 MB, whatever the length of the run

    Samples wake_, period_, step_, stepInContact_;
    std::array<Samples, kStageCount> stages_;
    int64_t lastWakeNs_ = -1;
    uint64_t nextStep_ = 0;
    uint64_t ticks_ = 0, contactTicks_ = 0;
    WorkMeter work_, commandWork_;
    double balance_ = 0.0, maxBalance_ = 0.0;
    uint64_t gaps_ = 0, gapsWithinMicrometre_ = 0;
    double maxGap_ = 0.0;
    double forceSum_ = 0.0, maxForce_ = 0.0, maxPenetration_ = 0.0;
    std::array<uint64_t, kFlagCount> flags_{};
};

/// Upper ends of the histogram bins, µs: 1, 2, 5 in each decade, from a free tick to a missed schedule.
inline constexpr std::array<int64_t, 13> kHistogramEndsUs{1,   2,   5,    10,   20,   50,   100,
                                                          200, 500, 1000, 2000, 5000, 10000};
/// Number of times (ns) in each bin; one more bin above the last end.
[[nodiscard]] std::vector<uint64_t> histogramOf(const Samples& nanoseconds);
/// {to_us: upper ends of the bins, ticks: counts}; the last bin has no end (null).
[[nodiscard]] nlohmann::ordered_json histogramJson(const Samples& nanoseconds);

/// Distance of the proxy sphere's surface from the mesh in a contact tick, m, up to 1 mm. `motions`: the
/// poses of that tick; empty: at rest.
[[nodiscard]] double proxyGap(const HapticScene& scene, ObjectMotions motions, const HapticOutput& output,
                              const HapticSettings& settings);

} // namespace touchstone
