#pragma once
// Times ticks so that a drifting machine cannot fake a difference: every configuration takes its turn in
// every round.

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

/// One way to touch one scene.
struct TimedConfiguration {
    std::string name;
    const BenchScene* scene = nullptr;
    HapticSettings settings;
    double speed = 0.1; ///< m/s
};

/// One turn of a configuration: its ticks in contact, ns; reading the clock twice is part of each.
struct RoundTimes {
    std::vector<double> whole;                           ///< the steps that nothing was read in
    std::array<std::vector<double>, kStageCount> upTo{}; ///< others, from their start to the end of a stage
};

/// What its ticks in contact took, ns; reading the clock twice (`clockCostNs`) is part of each.
struct ConfigurationTimes {
    Samples step;
    Samples ray;     ///< the floor: one Embree ray from proxy to HIP for each of those ticks
    Samples poses;   ///< where objects move: sampling the animation, of all ticks and beside the step
    Samples longest; ///< the longest step of each round, contact or not
    uint64_t pinchedTicks = 0; ///< TickFlag::Jammed, contact or not
    uint64_t ticks = 0;
    uint64_t contactTicks = 0;
    uint64_t iterations = 0;        ///< of all ticks in contact
    uint64_t flaggedTicks = 0;      ///< in contact, with a flag of the solver
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
    /// In eight ticks of twelve the clock is read at the end of one stage, of each in turn; what is told of
    /// whole steps is of the others.
    bool stages = false;
    /// 0: every configuration comes down from above where its own stretch begins. Else all begin where the
    /// path does, and each has lived, untimed, this many ticks more than the one before when its turns begin.
    uint64_t ahead = 0;
};

/// Strokes with each configuration in turn, `ticksPerRound` ticks a turn. Each configuration strokes a
/// stretch of its own, so that none finds in the cache what another one has fetched. Calling thread;
/// `progress` gets 0..1.
[[nodiscard]] std::vector<ConfigurationTimes>
timeConfigurations(std::span<const TimedConfiguration> configurations, const BenchPlan& plan,
                   const std::function<void(double)>& progress);

/// The median over the rounds of `above`'s median by `below`'s.
[[nodiscard]] double medianRatio(const ConfigurationTimes& above, const ConfigurationTimes& below);

} // namespace touchstone
