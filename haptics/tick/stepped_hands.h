#pragma once
// Several hands that are stepped without a servo.

#include "haptics/tick/haptic_step.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace touchstone {

/// Hands in one world, as SteppedHand: what one of them moves or wears off the others feel. 1..kMaxHands.
struct SteppedHands {
    SteppedHands(const HapticScene& touched, ScenePtr source, size_t hands)
        : scene(&touched), world(std::move(source), touched), samples(hands), states(hands), outputs(hands),
          traces(hands) {}

    /// Begins the tick at `now` (s): the objects' poses.
    void advance(double now, const HapticSettings& settings) noexcept {
        time = now;
        world.advance(animationTime(settings, now));
    }
    /// The tick itself, `dt` s long, of `samples`.
    template <class Stopwatch>
    void step(const HapticSettings& settings, double dt, Stopwatch& stopwatch) noexcept {
        const TickInput input{.tick = number++, .time = time, .dt = dt, .late = false, .hands = samples};
        hapticStep(*scene, settings, input, world, states, outputs, stopwatch);
    }

    const HapticScene* scene;
    WorldState world;
    // One per hand:
    std::vector<DeviceSample> samples;
    std::vector<DeviceState> states;
    std::vector<HapticOutput> outputs; ///< of the last tick
    std::vector<StageTrace> traces;
    double time = 0.0;   ///< s, of the last `advance`
    uint64_t number = 0; ///< of the next tick
};

} // namespace touchstone
