#pragma once
// Views of cameras that stand in the scene: of the file, or placed by hand. Pure; any thread.

#include "engine/scene/scene.h"
#include "renderer/view.h"

#include <string>

namespace touchstone {

/// Why no camera can stand at `eye` and look at `target` with `up` upwards (scene frame, m); empty: it can.
[[nodiscard]] std::string sightProblem(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// A perspective camera at `eye` that looks at `target` (scene frame, m), with `up` upwards in the picture;
/// `fovY` rad. Needs a sight without problem.
[[nodiscard]] SceneCamera lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up,
                                 double fovY);

/// What is upwards for a camera that is given no other: +y; along y, what is at the top of the views from
/// above (-z) and below (+z).
[[nodiscard]] glm::dvec3 usualUp(const glm::dvec3& eye, const glm::dvec3& target);

/// Its frame is wholly in the picture, whatever the picture's aspect (width / height); the light is that of
/// an OrbitCamera. Near and far plane close in on `sceneBounds`, which is all that is drawn; in a perspective
/// the near plane is at least a thousandth as far as the far plane, for the depth's resolution.
[[nodiscard]] View viewOf(const SceneCamera& camera, const Similarity& workspaceFromScene,
                          const Bounds& sceneBounds, double aspect);

/// Why a picture of this camera, `height` pixels high, shows nothing of what is within `sceneBounds`; empty:
/// it may show something.
[[nodiscard]] std::string unseenBecause(const SceneCamera& camera, const Bounds& sceneBounds, double aspect,
                                        int height);

} // namespace touchstone
