#pragma once

#include "engine/math/object_motion.h"

#include <glm/glm.hpp>

namespace touchstone {

class HapticScene;

/// The distance of `point` (workspace, m) from the nearest triangle of the whole scene, in double, or
/// `within` where none is nearer. For reports and tests: the tick does not use it. `motions` as in TickInput,
/// empty: at rest. Any thread but the servo; builds the rays where they are missing, and throws Error when
/// Embree fails.
[[nodiscard]] double surfaceDistance(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& point,
                                     double within);

} // namespace touchstone
