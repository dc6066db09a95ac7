#pragma once
// The path that `touch` follows, and its ticks.

#include "devices/simulated/replay_device.h"
#include "devices/stroke/stroke_path.h"
#include "workbench/options/commands.h"

#include <glm/glm.hpp>

#include <vector>

namespace touchstone {

struct PlannedTick {
    double time = 0.0; ///< s, as in the path
    double dt = 0.0;   ///< s
    glm::dvec3 hip{0.0};
};

/// A stroke over the model as a path: one period, or the given duration.
[[nodiscard]] HipPath pathOf(const StrokePath& stroke, const TouchOptions& options);

/// Rows a second of a path: of the median interval. 0 for a single row.
[[nodiscard]] double rateOf(const HipPath& path);

/// A path with fewer rows a second than the slowest servo has ticks is no motion of a hand that a tick could
/// follow.
void warnOfSlowPath(const HipPath& path, const TouchOptions& options);

/// The ticks of the path: one per row, or at a fixed rate with linear interpolation.
[[nodiscard]] std::vector<PlannedTick> plannedTicks(const HipPath& path, double rateHz);

} // namespace touchstone
