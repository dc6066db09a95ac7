#pragma once

#include "haptics/scene/haptic_scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace touchstone {

/// What a planned effect adds to a tick.
struct EffectCost {
    /// ns; 0 where it is off: nothing of it is in the tick. None where it could not be measured: no stroke
    /// touched its material. May be a little below zero: the difference of two medians.
    std::optional<int64_t> nanoseconds;
    uint64_t ticks = 0; ///< that it was measured over
};

/// Strokes the largest triangles of each material that has an effect, once with it and once without it, the
/// two in turn tick by tick so that a drifting machine cannot fake a difference. One for each effect of the
/// scene's plan. Calling thread; some 10 ms an effect, and no more than `longestNs` ns of ticks for all of
/// them: a tick is microseconds, but may be milliseconds where thousands of triangles lie in one place. An
/// effect that the time did not suffice for is not measured.
[[nodiscard]] std::vector<EffectCost> effectCosts(const HapticScene& scene,
                                                  int64_t longestNs = 2'000'000'000);

} // namespace touchstone
