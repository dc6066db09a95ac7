#pragma once

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// The object whose bounding sphere is nearest to `hip` (workspace); the first reference object.
[[nodiscard]] int nearestObject(const HapticScene& scene, ObjectMotions motions,
                                const glm::dvec3& hip) noexcept;

/// True where `hip` (workspace) is inside a closed object.
[[nodiscard]] bool isInsideAny(const HapticScene& scene, ObjectMotions motions,
                               const glm::dvec3& hip) noexcept;

/// Whether touch may begin at state.hip: not inside a closed object and, where the hand must leave the model
/// first, clear of it (clear_of_model.h); then it need not leave any more.
[[nodiscard]] bool mayBegin(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone
