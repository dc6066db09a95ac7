#pragma once
// Stage 6: friction as a stiction point on the surface ([001 §4.1], the god-object's god-object). The law is
// one of friction_law.h; this stage moves the proxy accordingly.

#include "haptics/friction/friction_cone.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Holds the proxy back by the law that the settings select. `velocity` of the hand relative to the surface,
/// m/s, reference object frame, as the device feels it; `dt`: s since the last tick. On entry the proxy is
/// where stage 4 left it; `held` is its place at the end of the last tick (reference object frame). The
/// solver moves the proxy from its former places, so it stays on the surface and inside all planes; where it
/// sticks it returns to `held` to the last bit, so that nothing drifts. Returns the friction force over K
/// (reference object units): the vector from the frictionless place to the proxy, no longer than the law's
/// stretch. Solver: ProxySolver or ComparisonSolver.
template <class Solver>
glm::dvec3 applyFriction(const HapticSettings& settings, const FrictionCone& cone, const glm::dvec3& velocity,
                         double dt, const glm::dvec3& held, Solver& proxy, DeviceState& state,
                         SolveResult& rest) noexcept;

} // namespace touchstone
