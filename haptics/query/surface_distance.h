#pragma once

#include "engine/math/object_motion.h"

#include <glm/glm.hpp>

namespace touchstone {

class HapticScene;

/// The distance of `point` (workspace, m) from the nearest triangle of the whole scene, in double, or
/// `within` where there is none so near. For reports and tests: it is not what the tick uses. `motions` as in
/// TickInput, empty: at rest. Any thread but the servo; builds the rays where they are not there, and throws
/// Error when Embree fails.
[[nodiscard]] double surfaceDistance(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& point,
                                     double within);

} // namespace touchstone
