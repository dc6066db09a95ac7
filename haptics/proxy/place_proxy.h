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

/// True where touch may begin at state.hip: outside every closed object and, where the hand must first leave
/// the model, clear of it (clear_of_model.h); the hand then counts as having left.
[[nodiscard]] bool mayBegin(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone
