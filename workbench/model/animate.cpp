#include "workbench/model/animate.h"

#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "haptics/body/body_world.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
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

void poseSoft(SoftStates& soft, const Scene& scene, const HapticScene& haptic, SceneRenderer& renderer) {
    if (!renderer.hasScene())
        return;
    (void)soft.publication().update();
    std::span<const glm::vec3> places = soft.publication().value();
    DrawnVertices drawn;
    for (const SoftStates::Shown& shown : soft.shown()) {
        const HapticObject& object = *haptic.objects[shown.object];
        const int m = scene.instances[static_cast<size_t>(object.instance)].mesh;
        const Mesh& mesh = scene.meshes[static_cast<size_t>(m)];
        const glm::dmat4 meshFromObject = glm::inverse(object.objectFromMesh);
        drawn = {mesh.positions, std::vector<glm::vec3>(mesh.normals.size(), glm::vec3(0.0f)), mesh.tangents};
        // Triangles have their corners in either order: normals face as those of the mesh at rest do.
        std::vector<glm::vec3> sums(shown.vertices, glm::vec3(0.0f));
        std::vector<glm::vec3> inMesh;
        for (const glm::vec3& place : places.first(shown.vertices))
            inMesh.emplace_back(glm::dvec3(meshFromObject * glm::dvec4(glm::dvec3(place), 1.0)));
        const bool mirrors = glm::determinant(object.objectFromMesh) < 0.0;
        for (size_t i = 0; i + 2 < object.indices.size(); i += 3) {
            std::array<glm::vec3, 3> at;
            for (size_t k = 0; k < 3; ++k) {
                at[k] = inMesh[object.indices[i + k]];
                drawn.positions[object.sourceIndices[i + k]] = at[k];
            }
            const glm::vec3 twice = glm::cross(at[1] - at[0], at[2] - at[0]) * (mirrors ? -1.0f : 1.0f);
            for (size_t k = 0; k < 3; ++k)
                sums[object.indices[i + k]] += twice;
        }
        for (size_t i = 0; i < object.indices.size() && !drawn.normals.empty(); ++i)
            if (const glm::vec3& sum = sums[object.indices[i]]; glm::length(sum) > 0.0f)
                drawn.normals[object.sourceIndices[i]] = glm::normalize(sum);
        renderer.setMeshVertices(m, drawn);
        places = places.subspan(shown.vertices);
    }
}

} // namespace touchstone
