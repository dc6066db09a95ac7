#pragma once

#include "engine/scene/scene.h"
#include "renderer/scene_renderer.h"

namespace touchstone {

/// Moves the rendered objects to their poses in the tick at `time`, s. Does nothing for a static scene. Main
/// thread.
void poseAt(double time, const Scene& scene, SceneRenderer& renderer);

} // namespace touchstone
