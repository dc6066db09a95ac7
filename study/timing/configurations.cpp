#include "study/timing/configurations.h"

#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/query/ray_floor.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/tick/stepped_hand.h"

#include <algorithm>
#include <optional>

namespace touchstone {

namespace {

constexpr double kTick = 1e-3;     // s
constexpr double kApproach = 0.02; // m, above the stroke's depth when it begins
constexpr double kDescent = 0.1;   // m/s

/// Consecutive ticks timed alike, so that the processor finds code and branch predictions unchanged.
constexpr uint64_t kAlike = 4;

/// The stage at whose end the clock is read in a tick, or none: in every third group of four. Each twelve
/// groups start at another stage; otherwise a periodic path could read one stage at one place only.
std::optional<Stage> splitOf(uint64_t tick) {
    constexpr uint64_t kRow = 3 * kStageCount / 2,
                       kGolden = 0x9e3779b97f4a7c15u; // 2^64 over the golden ratio
    const uint64_t four = tick / kAlike;
    const uint64_t turn = (four + (four / kRow * kGolden >> 32)) % kRow;
    if (turn % 3 == 0)
        return std::nullopt;
    return static_cast<Stage>(2 * (turn / 3) + turn % 3 - 1);
}

/// One configuration with its state between turns.
class Turn {
  public:
    Turn(const TimedConfiguration& configuration, double start)
        : configuration_(configuration), start_(start),
          hand_(*configuration.scene->haptic, configuration.scene->animated) {}

    /// Ticks without timing.
    void live(uint64_t ticks) {
        ConfigurationTimes untimed;
        for (uint64_t i = 0; i < ticks; ++i)
            tick(handAt(number_), untimed);
    }

    void take(int ticks, bool stages, ConfigurationTimes& times) {
        hands_.resize(static_cast<size_t>(ticks));
        touched_.clear();
        touched_.reserve(hands_.size());
        for (size_t i = 0; i < hands_.size(); ++i)
            hands_[i] = handAt(number_ + i);
        RoundTimes round;
        round.whole.reserve(hands_.size());
        for (auto& split : round.upTo)
            split.reserve(hands_.size() / kStageCount);
        Samples step;
        int64_t longest = 0;
        const RealtimeViolations before = realtime::violations();
        for (size_t i = 0; i < hands_.size(); ++i) {
            const std::optional<Stage> split = stages ? splitOf(number_) : std::nullopt;
            const int64_t ns = split ? splitTick(hands_[i], *split, times) : tick(hands_[i], times);
            times.pinchedTicks += has(hand_.output.flags, TickFlag::Jammed) ? 1 : 0;
            if (!split)
                longest = std::max(longest, ns);
            if (hand_.output.contacts == 0)
                continue;
            touched_.push_back({hand_.output.proxy, hand_.output.hip, hand_.output.object, touchedPose()});
            if (split) {
                round.upTo[static_cast<size_t>(*split)].push_back(static_cast<double>(ns));
                continue;
            }
            if (stages)
                round.whole.push_back(static_cast<double>(ns));
            step.add(ns);
            times.step.add(ns);
            times.iterations += hand_.output.iterations;
            times.flaggedTicks += has(hand_.output.flags, TickFlag::BudgetReached) ||
                                          has(hand_.output.flags, TickFlag::CandidatesFull)
                                      ? 1
                                      : 0;
        }
        const RealtimeViolations after = realtime::violations();
        times.allocations +=
            after.allocations - before.allocations + after.deallocations - before.deallocations;
        times.ticks += hands_.size();
        times.contactTicks += step.count();
        times.medians.push_back(static_cast<double>(step.percentile(0.5)));
        times.longest.add(longest);
        if (stages)
            times.rounds.push_back(std::move(round));
        castRays(times);
    }

  private:
    [[nodiscard]] glm::dvec3 handAt(uint64_t number) const {
        const double time = kTick * static_cast<double>(number);
        return configuration_.scene->stroke(start_ + configuration_.speed * time,
                                            std::max(0.0, kApproach - kDescent * time));
    }

    int64_t tick(const glm::dvec3& hand, ConfigurationTimes& times) {
        NoStopwatch none;
        return tickWith(hand, times, none);
    }
    int64_t splitTick(const glm::dvec3& hand, Stage until, ConfigurationTimes& times) {
        SplitStopwatch watch;
        watch.until = until;
        tickWith(hand, times, watch);
        return watch.nanoseconds;
    }

    template <class Stopwatch>
    int64_t tickWith(const glm::dvec3& hand, ConfigurationTimes& times, Stopwatch& stopwatch) {
        const DeviceSample sample = sampleAt(hand);
        const double time = kTick * static_cast<double>(number_++);
        long long posed = 0, begin = 0, end = 0;
        {
            const realtime::TickScope scope;
            const long long start = monotonicNs();
            hand_.advance(time, configuration_.settings);
            begin = monotonicNs();
            posed = begin - start;
            (void)hand_.step(configuration_.settings, sample, kTick, stopwatch);
            end = monotonicNs();
        }
        if (hand_.world.moving())
            times.poses.add(posed);
        return end - begin;
    }

    void castRays(ConfigurationTimes& times) {
        float sum = 0.0f;
        for (const Touched& t : touched_) {
            if (t.object < 0 ||
                configuration_.scene->haptic->objects[static_cast<size_t>(t.object)]->shape != nullptr)
                continue; // rays are cast at triangles
            const long long begin = monotonicNs();
            sum += castFloorRay(*configuration_.scene->haptic, t.object, t.pose, t.proxy, t.hip);
            times.ray.add(monotonicNs() - begin);
        }
        [[maybe_unused]] static volatile float sink;
        sink = sum; // keeps the compiler from removing the rays
    }

    /// Target of a floor ray, and the object's pose.
    struct Touched {
        glm::dvec3 proxy, hip;
        int object;
        Similarity pose;
    };
    [[nodiscard]] Similarity touchedPose() const {
        if (hand_.output.object < 0)
            return {};
        const ObjectMotions moved = hand_.world.poses(),
                            motions = moved.empty() ? ObjectMotions(configuration_.scene->haptic->restMotions)
                                                    : moved;
        return motions[static_cast<size_t>(hand_.output.object)].workspaceFromObject;
    }

    const TimedConfiguration& configuration_;
    double start_;
    SteppedHand hand_; ///< with one output for all ticks, as in the servo
    std::vector<glm::dvec3> hands_;
    std::vector<Touched> touched_;
    uint64_t number_ = 0;
};

} // namespace

std::vector<ConfigurationTimes> timeConfigurations(std::span<const TimedConfiguration> configurations,
                                                   const BenchPlan& plan,
                                                   const std::function<void(double)>& progress) {
    enterFloatMode();
    std::vector<Turn> turns;
    turns.reserve(configurations.size());
    double start = 0.0;
    for (const TimedConfiguration& configuration : configurations) {
        turns.emplace_back(configuration, start);
        if (plan.ahead > 0)
            turns.back().live(plan.ahead * (turns.size() - 1));
        else
            start += configuration.speed * kTick * plan.rounds * plan.ticksPerRound;
    }
    std::vector<ConfigurationTimes> times(configurations.size());
    for (int round = 0; round < plan.rounds; ++round) {
        progress(static_cast<double>(round) / plan.rounds);
        for (size_t i = 0; i < turns.size(); ++i)
            turns[i].take(plan.ticksPerRound, plan.stages, times[i]);
    }
    progress(1.0);
    return times;
}

double medianRatio(const ConfigurationTimes& above, const ConfigurationTimes& below) {
    std::vector<double> ratios;
    for (size_t i = 0; i < std::min(above.medians.size(), below.medians.size()); ++i)
        ratios.push_back(above.medians[i] / below.medians[i]);
    if (ratios.empty())
        return 0.0;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    return *middle;
}

} // namespace touchstone
