#pragma once
// Times ticks robustly against a drifting machine: every configuration takes a turn in every round.

#include "engine/time/samples.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/tick/stopwatch.h"
#include "study/timing/bench_scene.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// One configuration on one scene.
struct TimedConfiguration {
    std::string name;
    const BenchScene* scene = nullptr;
    HapticSettings settings;
    double speed = 0.1; ///< m/s
};

/// One turn of a configuration: its contact ticks, ns; each includes two clock readings.
struct RoundTimes {
    std::vector<double> whole;                           ///< steps without intermediate readings
    std::array<std::vector<double>, kStageCount> upTo{}; ///< other steps, from their start to the end of a
                                                         ///< stage
};

/// Times of the contact ticks, ns; each includes two clock readings (`clockCostNs`).
struct ConfigurationTimes {
    Samples step;
    Samples ray;     ///< the floor: one Embree ray from proxy to HIP for each of those ticks
    Samples poses;   ///< with moving objects: sampling the animation, over all ticks and outside the step
    Samples longest; ///< the longest step of each round, with or without contact
    uint64_t pinchedTicks = 0; ///< TickFlag::Jammed, with or without contact
    uint64_t ticks = 0;
    uint64_t contactTicks = 0;
    uint64_t iterations = 0;        ///< over all contact ticks
    uint64_t flaggedTicks = 0;      ///< in contact, with a solver flag
    uint64_t allocations = 0;       ///< and deallocations, in all ticks
    std::vector<double> medians;    ///< ns, step, of each round
    std::vector<RoundTimes> rounds; ///< with BenchPlan::stages

    [[nodiscard]] double median() const { return static_cast<double>(step.percentile(0.5)); }
    [[nodiscard]] double p99() const { return static_cast<double>(step.percentile(0.99)); }
    [[nodiscard]] double rayMedian() const { return static_cast<double>(ray.percentile(0.5)); }
    [[nodiscard]] double meanIterations() const {
        return contactTicks > 0 ? static_cast<double>(iterations) / static_cast<double>(contactTicks) : 0.0;
    }
    [[nodiscard]] double inRays() const { return median() / rayMedian(); }
};

struct BenchPlan {
    int rounds = 20;
    int ticksPerRound = 1000;
    /// In eight ticks of twelve the clock is read at the end of one stage, each in turn; figures of whole
    /// steps use the other ticks.
    bool stages = false;
    /// 0: every configuration descends at the start of its own stretch. Else all start with the path, and
    /// each has run this many more untimed ticks than the previous one when its turns start.
    uint64_t ahead = 0;
};

/// Strokes with each configuration in turn, `ticksPerRound` ticks per turn. Each configuration strokes its
/// own stretch, so that none finds data in the cache that another one fetched. Calling thread; `progress`
/// gets 0..1.
[[nodiscard]] std::vector<ConfigurationTimes>
timeConfigurations(std::span<const TimedConfiguration> configurations, const BenchPlan& plan,
                   const std::function<void(double)>& progress);

/// The median over the rounds of `above`'s median divided by `below`'s.
[[nodiscard]] double medianRatio(const ConfigurationTimes& above, const ConfigurationTimes& below);

} // namespace touchstone
