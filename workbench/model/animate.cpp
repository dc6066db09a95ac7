#include "workbench/model/animate.h"

#include "haptics/world/world_state.h"

namespace touchstone {

void poseAt(double time, const Scene& scene, SceneRenderer& renderer) {
    if (!renderer.hasScene())
        return; // still being uploaded
    if (const Animation* animation = playedAnimation(scene))
        renderer.setInstancePoses(sceneFromMeshAt(scene, animation, loopedTime(*animation, time)));
}

} // namespace touchstone
