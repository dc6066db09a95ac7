#pragma once
// Stage 6: friction as a stiction point on the surface ([001 §4.1], the god-object's god-object).

#include "haptics/proxy/mesh_proxy.h"
#include "haptics/texture/surface_feel.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Holds the proxy back. `frictionless` is where stage 4 left it; `held` where it stood at the end of the
/// last tick (both anchor frame). While the stretch |held - frictionless| is at most mu_s times the depth,
/// the proxy goes back to `held` to the last bit, so that nothing drifts; beyond it the stiction point slips
/// to mu_d times the depth behind the frictionless place (mu N / K = mu d: normal and tangential stiffness
/// are one). The proxy is moved by the solver, so it stays on the surface and inside all planes.
/// Model: MeshProxy or NeighbourhoodWatch.
template <class Model>
void applyStiction(const SurfaceFeel& feel, const glm::dvec3& held, double workspacePerAnchor, Model& proxy,
                   DeviceState& state) noexcept;

} // namespace touchstone
