#pragma once
// Stage 4, force shading: facets are felt as a smooth surface. Interpolated normals [000 §4.1] move the proxy
// (Ruspini's two passes), or turn the force (Ho, Morgenbesser).

#include "haptics/proxy/proxy_solver.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/shading/first_goal.h"
#include "haptics/shading/shading_mode.h"

#include <glm/glm.hpp>

namespace touchstone {

/// The interpolated vertex normal at a contact (reference object frame, unit), on the proxy's side and tilted
/// from the true normal by at most `tiltLimit` (rad). Barycentric weights [000 §4.1, eq. 1]; on an edge they
/// are the two vertices' weights by inverse distance and at a vertex its own normal, which agrees with the
/// paper's cases. The true normal where the triangle is flat. `patch`: of tactile shading's patch
/// (kBezierShading).
[[nodiscard]] glm::dvec3 interpolatedNormal(const HapticScene& scene, ObjectMotions motions, int reference,
                                            const Contact& contact, double tiltLimit,
                                            bool patch = false) noexcept;

/// Ruspini's two-pass shading iterated to its fixed point: goal = nearest point to the HIP on the
/// interpolated planes through the proxy; the proxy then moves to the point of the true surface nearest to
/// that goal; repeated with the normals of the new place until the goal is stationary. The force is then
/// along the interpolated normal of the final proxy. `first`: the goal of stage 3. Sets ShadingNotConverged.
/// Solver: ProxySolver or ComparisonSolver.
template <class Solver>
void shadeTwoPass(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                  const glm::dvec3& hip, const FirstGoal& first, Solver& proxy, DeviceState& state,
                  SolveResult& rest) noexcept;

/// What a single round starts from: the contacts of the proxy where the last tick left it, without a move; in
/// the air those of the rest that it comes to.
template <class Solver>
void findShaded(const glm::dvec3& hip, Solver& proxy, DeviceState& state, SolveResult& rest) noexcept;

/// Ruspini's two-pass shading as [000 §4] prints it, one round a tick: the interpolated planes go through the
/// contacts that the proxy has before it moves (findShaded); the nearest point to the HIP on them, put back
/// onto the nearest true plane where it is above all of them, is the goal of the second pass. The force is
/// along the normal of the place before: a hand that rests comes to shadeTwoPass's fixed point tick by tick,
/// one that moves feels the normal of a tick ago.
template <class Solver>
void shadeSingleRound(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                      const glm::dvec3& hip, Solver& proxy, DeviceState& state, SolveResult& rest) noexcept;

} // namespace touchstone
