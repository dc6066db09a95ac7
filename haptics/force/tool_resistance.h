#pragma once
// What a sculpting tool feels of the solid that it takes away.

#include "engine/math/similarity.h"
#include "haptics/shape/field/sculpt/live_tool.h"
#include "haptics/shape/shape.h"

#include <glm/glm.hpp>

namespace touchstone {

/// m^3/s: the volume of a solid that a ball of `radius` (m) at `centre` sweeps at `velocity` (m/s), all in
/// the workspace. The integral of (v.n)+ over the part of the sphere inside of the solid, by 96 points of
/// equal area: within 3 % of pi r^2 v deep inside. No allocation; 96 values of the field at most.
[[nodiscard]] double sweptVolume(const PotentialField& field, const Similarity& workspaceFromObject,
                                 const glm::dvec3& centre, double radius,
                                 const glm::dvec3& velocity) noexcept;

/// N, workspace: against the motion, LiveTool::resistance for each volume a second, as far as `mass` (kg, the
/// device's apparent mass) bears it: a drag above m / (4 dt) would not be stable in a sampled loop of one
/// tick's delay. Zero for a tool that takes nothing away.
[[nodiscard]] glm::dvec3 toolResistance(const PotentialField& field, const Similarity& workspaceFromObject,
                                        const LiveTool& tool, const glm::dvec3& centre,
                                        const glm::dvec3& velocity, double mass, double dt) noexcept;

} // namespace touchstone
