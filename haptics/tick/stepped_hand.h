#pragma once
// One hand that is stepped without a servo: for `touch`, studies, reports and tests.

#include "haptics/tick/haptic_step.h"

#include <cstdint>
#include <span>
#include <utility>

namespace touchstone {

/// The input of a hand at a position of the device's frame, without clutch and zoom.
[[nodiscard]] inline DeviceSample sampleAt(const glm::dvec3& position) {
    DeviceSample sample;
    sample.position = position;
    sample.valid = true;
    return sample;
}

/// A scene and its world, tick by tick, without hands.
struct SteppedWorld {
    /// `scene` outlives it. The animation of `source` moves its objects; null: nothing moves.
    explicit SteppedWorld(const HapticScene& touched, ScenePtr source = nullptr)
        : scene(&touched), world(std::move(source), touched) {}

    /// Begins the tick at `now` (s): the objects' poses. May be omitted where nothing moves: `time` then
    /// stays. `settings`: those of the animation.
    void advance(double now, const HapticSettings& settings = {}) noexcept {
        time = now;
        world.advance(animationTime(settings, now));
    }
    /// The tick itself, `dt` s long, of as many hands as there are samples, states and outputs.
    template <class Stopwatch>
    void step(const HapticSettings& settings, std::span<const DeviceSample> samples,
              std::span<DeviceState> states, std::span<HapticOutput> outputs, double dt,
              Stopwatch& stopwatch) noexcept {
        const TickInput input{.tick = number++, .time = time, .dt = dt, .late = false, .hands = samples};
        hapticStep(*scene, settings, input, world, states, outputs, stopwatch);
    }

    const HapticScene* scene;
    WorldState world;
    double time = 0.0;   ///< s, of the last `advance`
    uint64_t number = 0; ///< of the next tick
};

/// A scene with one hand and the world around it, tick by tick. Construct off the servo (it allocates a
/// DeviceState); `advance` and `step` do not allocate. Deterministic; one thread.
struct SteppedHand : SteppedWorld {
    using SteppedWorld::SteppedWorld;

    /// The tick itself. Apart from `advance`, so that a study can time it alone.
    template <class Stopwatch>
    const HapticOutput& step(const HapticSettings& settings, const DeviceSample& sample, double dt,
                             Stopwatch& stopwatch) noexcept {
        SteppedWorld::step(settings, {&sample, 1}, {&state, 1}, {&output, 1}, dt, stopwatch);
        return output;
    }
    /// Both, without a stopwatch.
    const HapticOutput& tick(const HapticSettings& settings, const DeviceSample& sample, double now,
                             double dt) noexcept {
        NoStopwatch none;
        advance(now, settings);
        return step(settings, sample, dt, none);
    }

    DeviceState state;
    HapticOutput output; ///< of the last tick
};

} // namespace touchstone
