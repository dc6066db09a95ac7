#pragma once

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

#include <span>

namespace touchstone {

/// The object whose bounding sphere is nearest to `hip` (workspace); the first reference object. One that is
/// hidden or cut away only where nothing else is left.
[[nodiscard]] int nearestObject(const HapticScene& scene, ObjectMotions motions,
                                const glm::dvec3& hip) noexcept;

/// True where `hip` (workspace) is inside a closed object.
[[nodiscard]] bool isInsideAny(const HapticScene& scene, ObjectMotions motions,
                               const glm::dvec3& hip) noexcept;

/// True where touch may begin at state.hip: outside every closed object and, where the hand must first leave
/// the model, clear of it (clear_of_model.h); the hand then counts as having left.
[[nodiscard]] bool mayBegin(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

/// Touch begins again where the hand is next sampled; `mustLeave`: once it is clear of the model.
void beginTouch(DeviceState& state, bool mustLeave) noexcept;

/// The hand begins again once it is clear of the model: what stood behind a surface that is gone, or one that
/// has come to be around it, would push at full depth.
void letGo(DeviceState& state) noexcept;

/// Between two ticks, after objects of the scene have lost all their triangles (SceneSwap::SameGeometry).
/// `motions`: of the preceding tick. A hand that touched one of them begins again, once it is clear of what
/// is left: what stood behind it would push at full depth. Any other touch goes on, in the frame of an object
/// that is left. A hand that holds the body of one lets it go.
void letGoOfEmptied(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

/// Between two ticks, after the fields of `reshaped` (HapticScene::objects) have changed. `motions`: of the
/// preceding tick. What was gathered near the proxy is dropped. A hand whose proxy one of them has come to
/// cover by more than a voxel begins again, once it is clear of the model: it would push at full depth. Any
/// other touch goes on; a proxy that is covered by less is lifted by the next solve.
void takeUpReshaped(const HapticScene& scene, ObjectMotions motions, std::span<const int> reshaped,
                    DeviceState& state) noexcept;

} // namespace touchstone
