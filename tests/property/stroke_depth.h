#pragma once
// The invariant of every stroke of the simulated hand: it touches, and never presses deeper than 1.5 times
// the depth that was asked for.

#include "engine/scene/scene.h"

#include <string>

namespace touchstone::test {

inline constexpr double kDepthFactor = 1.5; ///< deepest |proxy - HIP| over the depth asked for, at most

/// Lays every stroke of the library onto `scene`, feels it and expects the invariant. With
/// TOUCHSTONE_STROKE_TABLE set prints a row per stroke: name, stroke, asked (mm), deepest (mm), share of the
/// ticks in contact, a hash of the path's bits. Returns the number of strokes that broke it.
int expectStrokes(const ScenePtr& scene, const std::string& name);

} // namespace touchstone::test
