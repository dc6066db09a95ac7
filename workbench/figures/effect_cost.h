#pragma once

#include "haptics/scene/haptic_scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace touchstone {

/// The cost of a planned effect in a tick.
struct EffectCost {
    /// ns; 0 where it is off: the tick omits it. Nullopt where it could not be measured: no stroke touched
    /// its material. May be slightly negative: the difference of two medians.
    std::optional<int64_t> nanoseconds;
    uint64_t ticks = 0; ///< number of ticks of the measurement
};

/// Strokes the largest triangles of each material with an effect, once with and once without it, alternating
/// tick by tick so that a drifting machine does not bias the difference. One result for each effect of the
/// scene's plan. Calling thread; some 10 ms per effect, and at most `longestNs` ns of ticks for all of them:
/// a tick takes microseconds, but may take milliseconds where thousands of triangles lie in one place.
/// Effects beyond that time are not measured.
[[nodiscard]] std::vector<EffectCost> effectCosts(const HapticScene& scene,
                                                  int64_t longestNs = 2'000'000'000);

} // namespace touchstone
