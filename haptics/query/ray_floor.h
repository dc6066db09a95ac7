#pragma once

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

namespace touchstone {

class HapticScene;

/// Embree's floor: one rtcIntersect1 (ROBUST) from proxy to HIP (workspace, rest poses) against the object
/// `object`. What a tick costs is told in multiples of the time this takes. Returns the hit distance in
/// object units, infinity for none, so that no compiler can leave the ray out. Any thread.
float castFloorRay(const HapticScene& scene, int object, const glm::dvec3& proxy,
                   const glm::dvec3& hip) noexcept;
/// The same against the object as it stands at a tick.
float castFloorRay(const HapticScene& scene, int object, const Similarity& workspaceFromObject,
                   const glm::dvec3& proxy, const glm::dvec3& hip) noexcept;

} // namespace touchstone
