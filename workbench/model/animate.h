#pragma once

#include "engine/scene/scene.h"
#include "haptics/world/driven_objects.h"
#include "haptics/world/world_state.h"
#include "renderer/scene_renderer.h"

#include <span>

namespace touchstone {

/// Moves the rendered objects to their poses in the tick at `time`, s. Does nothing for a static scene. Main
/// thread.
void poseAt(double time, const Scene& scene, SceneRenderer& renderer);
/// The same, and objects of `haptic` where a caller has moved them (DrivenPose::now).
void poseMoved(double time, const Scene& scene, const HapticScene& haptic, std::span<const DrivenPose> moved,
               SceneRenderer& renderer);
/// The same as poseAt where bodies move: they are at `poses`, in `world`, which shows them
/// (WorldBodies::Shown).
void poseBodies(const body::BodyPoses& poses, double time, WorldState& world, SceneRenderer& renderer);

} // namespace touchstone
