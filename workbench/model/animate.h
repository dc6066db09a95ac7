#pragma once

#include "engine/scene/scene.h"
#include "renderer/scene_renderer.h"

namespace touchstone {

/// Puts what the eye sees where the hand felt it in the tick at `time`, s. Does nothing where nothing moves.
/// Main thread.
void poseAt(double time, const Scene& scene, SceneRenderer& renderer);

} // namespace touchstone
