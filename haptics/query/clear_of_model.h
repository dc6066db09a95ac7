#pragma once

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"

#include <glm/glm.hpp>

namespace touchstone {

/// m of the workspace. A hand nearer than this to a surface is within reach of the model. A hand that presses
/// on a model being replaced is up to 14 mm deep (8.5 N on 600 N/m) and accelerates when the model vanishes;
/// a mouse hovers 3 mm over a surface, but chooses its place in sight (DeviceSample::inSight).
inline constexpr double kModelReach = 5e-3;

/// True where `hip` (workspace) is out of the model: farther than kModelReach from every surface and not
/// enclosed. A closed object encloses by parity (isInsideAny). An open object has no inside; it encloses
/// where 10 of 14 directions meet a two-sided surface. From outside the convex hull of the surfaces 7 do at
/// most, since of two opposite directions one leads away from it; a sheet is met by 7. Servo thread: bounded
/// by objects times 14 rays and one search for a near triangle. Where the ball around the hand meets more
/// boxes than are tested one by one, the surface counts as near.
[[nodiscard]] bool clearOfModel(const HapticScene& scene, ObjectMotions motions,
                                const glm::dvec3& hip) noexcept;

/// The second half of that: two-sided surfaces are met in 10 of 14 directions from `point` (workspace).
[[nodiscard]] bool isEnclosed(const HapticScene& scene, ObjectMotions motions,
                              const glm::dvec3& point) noexcept;
/// The same of another part of the scene: of `part`, but where it has the objects of `scene` those of `now`,
/// which are as this tick deforms them (WorldState::touched).
[[nodiscard]] bool isEnclosedIn(const HapticScene& part, const HapticScene& scene, const HapticScene& now,
                                ObjectMotions motions, const glm::dvec3& point) noexcept;

} // namespace touchstone
