#pragma once
// Stage 7: the force before safety.

#include "haptics/surface/surface_sample.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Force in N in the frame of the arguments' directions. With stiffness k, depth d, height H, normals n and
/// m: texture=law: k [(d - H) n + H m] if d >= H, else k d m (the displacement law of [000], continuous at d
/// = H), and k d m where there is no height; blinn: k d m, the god-object's magnitude [001 §4.3.2]; minsky: k
/// d m / (n . m) = k d (n - grad H), a lateral force beside an unchanged normal one; plus k d times the
/// slope of a dent; plus friction k * (held
/// proxy - frictionless proxy); minus damping of the velocity into the surface (never pulling); plus the
/// viscous part of friction. `frictionStretch` in m, `velocity` of the HIP relative to the surface in m/s.
[[nodiscard]] glm::dvec3 springDamperForce(const SurfaceSample& feel, const glm::dvec3& frictionStretch,
                                           const glm::dvec3& viscousForce,
                                           const glm::dvec3& velocity) noexcept;

/// Fraction of a force that remains where the workspace is `zoom` > 1 times as large as the device's: the
/// device feels `stiffness` (N/m, workspace) times zoom, limited to what it can bear (limits.maxStiffness) or
/// to the value set explicitly. In (0, 1].
[[nodiscard]] double bearableShare(double stiffness, double zoom, const HapticSettings& settings,
                                   const DeviceLimits& limits) noexcept;

/// Fraction of a force (N) that remains where the hand gives way rather than bear more than `press` (N, > 0):
/// the direction stays, and with it the friction cone. A force that is not finite stays so.
[[nodiscard]] double yieldingShare(const glm::dvec3& force, double press) noexcept;

} // namespace touchstone
