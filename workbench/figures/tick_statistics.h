#pragma once

#include "engine/time/samples.h"
#include "haptics/force/work_meter.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/tick/haptic_step.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace touchstone {

/// What a stream of ticks amounts to, for `--json` and the panel. One thread.
class TickStatistics {
  public:
    /// `window`: ticks that the percentiles look back on; 0: all of them.
    explicit TickStatistics(size_t window = 0)
        : wake_(window), period_(window), step_(window), stepInContact_(window) {
        stages_.fill(Samples(window > 0 ? window : kStageWindow));
    }

    /// A tick of the real-time loop: with its wake-up.
    void addLive(const TickRecord& record);
    /// A tick of an offline run.
    void add(const HapticOutput& output, int64_t stepNs);
    /// In a tick with contact: how far the proxy sphere's surface was from the mesh, m.
    void addProxyGap(double gap);

    [[nodiscard]] uint64_t ticks() const { return ticks_; }
    [[nodiscard]] uint64_t contactTicks() const { return contactTicks_; }
    [[nodiscard]] const Samples& wake() const { return wake_; }
    [[nodiscard]] const Samples& step() const { return step_; }
    /// ns of each Stage over the live ticks in contact, the newest 600,000 of them.
    [[nodiscard]] const std::array<Samples, kStageCount>& stages() const { return stages_; }
    [[nodiscard]] const Samples& stepInContact() const { return stepInContact_; }

    /// {p50_ns, p99_ns, ...} over the ticks in contact (over all where none was), and the same over `all`.
    [[nodiscard]] nlohmann::ordered_json stepJson() const;
    /// {sample: {mean_ns, p50_ns, p99_ns}, contact: ...} over the live ticks in contact: zeros where the
    /// servo did not take the time.
    [[nodiscard]] nlohmann::ordered_json stagesJson() const;
    /// {p50_us, p99_us, p999_us, max_us}: wake-up against the deadline; period_p50_us: from wake-up to
    /// wake-up.
    [[nodiscard]] nlohmann::ordered_json wakeJson() const;
    /// {ticks, share, proxy_on_mesh_share, ...}; the share is null where no gap was measured.
    [[nodiscard]] nlohmann::ordered_json contactJson() const;
    /// {mean_n, max_n} over the ticks in contact, stage 7.
    [[nodiscard]] nlohmann::ordered_json forceJson() const;
    /// {given_j, law_j, sampling_j, command_given_j, gaps}: work on the hand over all ticks, see
    /// work_meter.h; gaps: how often records were dropped, whose work is not in it. balance_j and
    /// most_balance_j: of the passivity observer, see haptics/safety/passivity.h.
    [[nodiscard]] nlohmann::ordered_json energyJson() const;
    /// Ticks by TickFlag.
    [[nodiscard]] nlohmann::ordered_json flagsJson() const;

  private:
    static constexpr size_t kFlagCount = 16;
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

/// Upper ends of the bins in which times of ticks are counted, us: 1, 2, 5 in each decade, from a tick in the
/// free to a scheduler that forgot us.
inline constexpr std::array<int64_t, 13> kHistogramEndsUs{1,   2,   5,    10,   20,   50,   100,
                                                          200, 500, 1000, 2000, 5000, 10000};
/// How many of the times (ns) are in each bin; one bin more for what is over the last end.
[[nodiscard]] std::vector<uint64_t> histogramOf(const Samples& nanoseconds);
/// {to_us: upper ends of the bins, ticks: how many are in each}; the last bin has no end (null).
[[nodiscard]] nlohmann::ordered_json histogramJson(const Samples& nanoseconds);

/// How far the proxy sphere's surface is from the mesh in a tick with contact, m; at most 1 mm is looked at.
/// `motions` are the poses of that tick, empty: at rest.
[[nodiscard]] double proxyGap(const HapticScene& scene, ObjectMotions motions, const HapticOutput& output,
                              const HapticSettings& settings);

} // namespace touchstone
