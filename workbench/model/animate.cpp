#include "workbench/model/animate.h"

#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "haptics/body/body_world.h"

#include <vector>

namespace touchstone {

void poseAt(double time, const Scene& scene, SceneRenderer& renderer) {
    const Animation* animation = playedAnimation(scene);
    if (!renderer.hasScene() || animation == nullptr) // still being uploaded
        return;
    ScenePose pose(scene);
    pose.evaluate(scene, animation, loopedTime(*animation, time));
    renderer.setInstancePoses(pose.sceneFromMesh());
    const std::vector<bool> moved = movedNodes(scene, *animation);
    std::vector<bool> shown(scene.meshes.size(), false);
    for (const Instance& instance : scene.instances)
        shown[static_cast<size_t>(instance.mesh)] = true;
    DrawnVertices drawn;
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        if (!shown[m] || mesh.deformation == nullptr || !mesh.deformation->drivenBy(*animation, moved))
            continue;
        DeformedVertices vertices(*mesh.deformation), rest(*mesh.deformation);
        vertices.pose(pose);
        if (!mesh.tangents.empty())
            rest.pose(ScenePose(scene));
        deform(mesh, vertices, rest, drawn);
        renderer.setMeshVertices(static_cast<int>(m), drawn);
    }
}

void poseBodies(const body::BodyPoses& poses, double time, WorldState& world, SceneRenderer& renderer) {
    if (!renderer.hasScene())
        return;
    world.showBodies(poses);
    (void)world.advance(time);
    renderer.setInstancePoses(world.sceneFromMesh());
}

} // namespace touchstone
