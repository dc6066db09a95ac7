#pragma once
// One hand that is stepped without a servo: what `touch`, the studies, the reports and the tests do.

#include "haptics/tick/haptic_step.h"

#include <cstdint>
#include <utility>

namespace touchstone {

/// The input of a hand at a position of the device's frame, without clutch and zoom.
[[nodiscard]] inline DeviceSample sampleAt(const glm::dvec3& position) {
    DeviceSample sample;
    sample.position = position;
    sample.valid = true;
    return sample;
}

/// A scene with one hand and the world around it, tick by tick. Construct off the servo (it allocates a
/// DeviceState); `advance` and `step` have no more in them than the tick itself. Deterministic; one thread.
struct SteppedHand {
    /// `scene` outlives it. The animation of `source` moves its objects; null: nothing moves.
    explicit SteppedHand(const HapticScene& touched, ScenePtr source = nullptr)
        : scene(&touched), world(std::move(source), touched) {}

    /// Begins the tick at `time` (s): the objects' poses.
    void advance(double time) noexcept {
        input.time = time;
        world.advance(time);
    }
    /// The tick itself, `dt` s long. Apart from `advance`, so that a study can time it alone.
    template <class Stopwatch>
    const HapticOutput& step(const HapticSettings& settings, const DeviceSample& sample, double dt,
                             Stopwatch& stopwatch) noexcept {
        input.dt = dt;
        input.hands = {&sample, 1};
        hapticStep(*scene, settings, input, world, {&state, 1}, {&output, 1}, stopwatch);
        ++input.tick;
        return output;
    }
    /// Both, without a stopwatch.
    const HapticOutput& tick(const HapticSettings& settings, const DeviceSample& sample, double time,
                             double dt) noexcept {
        NoStopwatch none;
        advance(time);
        return step(settings, sample, dt, none);
    }

    const HapticScene* scene;
    WorldState world;
    DeviceState state;
    HapticOutput output; ///< of the last tick
    TickInput input;     ///< `tick` is the number of the next one; `late` is the caller's
};

} // namespace touchstone
