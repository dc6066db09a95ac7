#pragma once
// A touch goes on where another part of the scene comes to be felt.

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

namespace touchstone {

/// True where a touch can go on while another part of the scene comes to be felt: nothing in it is soft,
/// since a soft body that is cut or hidden has other vertices. `source`: what it was compiled from; null:
/// nothing moves.
[[nodiscard]] bool canTakeUpPart(const Scene* source);

/// Between two ticks, after another part of the same scene has come to be felt (SceneSwap::OtherPart):
/// objects have lost triangles, have been given them back, or are cut elsewhere, each in the frame that it
/// had (buildCutObject). `now`: `scene` with the vertices of the preceding tick (WorldState::touched).
/// `before`: what was felt; null where that is not known. `motions`: of the preceding tick. `radius`: of the
/// proxy, workspace m.
///
/// A hand goes on that is met by nothing and holds on to all that it held on to. It begins again once it is
/// clear of the model where a surface is nearer to the proxy than half its radius, closes around it or comes
/// to enclose it, or a surface that it touched is no longer there: what stood behind it would push at full
/// depth. On the servo: bounded by two searches for near triangles of each object and 14 rays to each.
void takeUpPart(const HapticScene& scene, const HapticScene& now, const HapticScene* before,
                ObjectMotions motions, double radius, DeviceState& state) noexcept;

} // namespace touchstone
