#pragma once
// What each tool makes of the values near it.

#include "haptics/shape/field/sculpt/field_window.h"
#include "haptics/shape/field/sculpt/restore_distance.h"
#include "haptics/shape/field/sculpt/sculpt_tool.h"

namespace touchstone {

/// The dab takes out or joins a ball: one side of the surface has a closed form (ExactSide).
[[nodiscard]] bool isWholeBall(const Dab& dab);

/// Radius of the ball in which a dab changes nodes by itself, object units: with two voxels around the tool.
[[nodiscard]] double changedRadius(const FieldGrid& grid, const Dab& dab);

/// Replaces the values in the zone. They are no distances yet, but on the side that is returned: a point in a
/// solid from which a ball is taken out is as far from its surface as the nearer of the two surfaces, and so
/// is one outside of a solid to which a ball is joined; there values are replaced in the whole window. The
/// object stays half a voxel inside of the grid.
[[nodiscard]] ExactSide applyTool(FieldWindow& window, const FieldGrid& grid, const Dab& dab,
                                  const SculptZone& zone);

} // namespace touchstone
