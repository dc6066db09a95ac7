#pragma once
// Stage 7: what the hand should feel, before safety.

#include "haptics/texture/surface_feel.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Force in N in the frame of the arguments' directions. With stiffness k, depth d, height H, normals n and
/// m: texture=law: k [(d - H) n + H m] if d >= H, else k d m (the displacement law of [000], continuous at
/// d = H), and k d m where there is no height; blinn: k d m, the god-object's magnitude [001 §4.3.2]; minsky:
/// k d m / (n . m) = k d (n - grad H), a lateral force beside an unchanged normal one; plus friction k *
/// (held proxy - frictionless proxy); minus damping of the velocity into the surface (never pulling) and
/// viscous friction along it. `frictionStretch` in m, `velocity` of the HIP against the surface in m/s.
[[nodiscard]] glm::dvec3 springDamperForce(const SurfaceFeel& feel, const glm::dvec3& frictionStretch,
                                           const glm::dvec3& velocity) noexcept;

} // namespace touchstone
