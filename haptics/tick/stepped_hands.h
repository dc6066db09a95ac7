#pragma once
// Several hands that are stepped without a servo.

#include "haptics/tick/stepped_hand.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace touchstone {

/// Hands in one world, as SteppedHand: what one of them moves or wears off the others feel. 1..kMaxHands.
struct SteppedHands : SteppedWorld {
    SteppedHands(const HapticScene& touched, ScenePtr source, size_t hands)
        : SteppedWorld(touched, std::move(source)), samples(hands), states(hands), outputs(hands) {}

    /// The tick itself, `dt` s long, of `samples`.
    template <class Stopwatch>
    void step(const HapticSettings& settings, double dt, Stopwatch& stopwatch) noexcept {
        SteppedWorld::step(settings, samples, states, outputs, dt, stopwatch);
    }

    // One per hand:
    std::vector<DeviceSample> samples;
    std::vector<DeviceState> states;
    std::vector<HapticOutput> outputs; ///< of the last tick
};

} // namespace touchstone
