#pragma once

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

namespace touchstone {

class HapticScene;

/// Embree's floor: one rtcIntersect1 (ROBUST) from proxy to HIP (workspace, rest poses) against the object
/// `object`. The cost of a tick is stated in multiples of its time. Returns the hit distance in object units,
/// infinity for none, so that no compiler can remove the ray. Any thread.
float castFloorRay(const HapticScene& scene, int object, const glm::dvec3& proxy,
                   const glm::dvec3& hip) noexcept;
/// The same against the object at its pose in a tick.
float castFloorRay(const HapticScene& scene, int object, const Similarity& workspaceFromObject,
                   const glm::dvec3& proxy, const glm::dvec3& hip) noexcept;

} // namespace touchstone
