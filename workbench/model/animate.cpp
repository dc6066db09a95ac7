#include "workbench/model/animate.h"

#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "haptics/body/body_world.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <span>
#include <vector>

namespace touchstone {

namespace {

ScenePose poseOf(double time, const Scene& scene) {
    ScenePose pose(scene);
    if (const Animation* animation = playedAnimation(scene))
        pose.evaluate(scene, animation, loopedTime(*animation, time));
    return pose;
}

/// The vertices that the played animation deforms.
void deformVertices(const ScenePose& pose, const Scene& scene, SceneRenderer& renderer) {
    const Animation* animation = playedAnimation(scene);
    if (animation == nullptr)
        return;
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

} // namespace

void poseAt(double time, const Scene& scene, SceneRenderer& renderer) {
    if (!renderer.hasScene() || playedAnimation(scene) == nullptr) // still being uploaded
        return;
    const ScenePose pose = poseOf(time, scene);
    renderer.setInstancePoses(pose.sceneFromMesh());
    deformVertices(pose, scene, renderer);
}

void poseMoved(double time, const Scene& scene, const HapticScene& haptic, std::span<const DrivenPose> moved,
               SceneRenderer& renderer) {
    if (!renderer.hasScene())
        return;
    const ScenePose pose = poseOf(time, scene);
    deformVertices(pose, scene, renderer);
    std::vector<glm::dmat4> sceneFromMesh(pose.sceneFromMesh().begin(), pose.sceneFromMesh().end());
    for (const DrivenPose& object : moved) {
        const auto index = static_cast<size_t>(object.object);
        if (index >= haptic.objects.size() || haptic.objects[index]->instance < 0)
            continue;
        const Similarity& rest = haptic.restMotions[index].workspaceFromObject;
        const Similarity way =
            haptic.workspaceFromScene.inverse() * (object.now * rest.inverse()) * haptic.workspaceFromScene;
        glm::dmat4& placed = sceneFromMesh[static_cast<size_t>(haptic.objects[index]->instance)];
        placed = glm::translate(glm::dmat4(1.0), way.translation) * glm::mat4_cast(way.rotation) * placed;
    }
    renderer.setInstancePoses(sceneFromMesh);
}

void poseBodies(const body::BodyPoses& poses, double time, WorldState& world, SceneRenderer& renderer) {
    if (!renderer.hasScene())
        return;
    world.showBodies(poses);
    (void)world.advance(time);
    renderer.setInstancePoses(world.sceneFromMesh());
}

} // namespace touchstone
