#pragma once
// What each tool makes of the values near it.

#include "haptics/shape/field/sculpt/field_window.h"
#include "haptics/shape/field/sculpt/sculpt_tool.h"

namespace touchstone {

/// Radius of the ball in which a dab changes nodes by itself, object units: with two voxels around the tool.
[[nodiscard]] double changedRadius(const FieldGrid& grid, const Dab& dab);

/// Replaces the values in the zone. They are no distances yet, but where the whole ball is taken out or
/// joined (strength 1, no falloff). The object stays half a voxel inside of the grid.
void applyTool(FieldWindow& window, const FieldGrid& grid, const Dab& dab, const SculptZone& zone);

} // namespace touchstone
