#include "engine/load/loose_bodies.h"

#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/scene/physics.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

constexpr double kMass = 0.1; // kg
constexpr double kDrag = 6.0; // 1/s

/// By node: what the file or an animation says of it, itself or through a parent.
std::vector<bool> spokenFor(const Scene& scene, const Physics& physics) {
    std::vector<bool> spoken(scene.nodes.size(), false);
    if (const Animation* animation = playedAnimation(scene)) {
        spoken = movedNodes(scene, *animation);
        for (const Instance& instance : scene.instances) {
            const auto& deformation = scene.meshes[static_cast<size_t>(instance.mesh)].deformation;
            if (instance.node >= 0 && deformation != nullptr)
                spoken[static_cast<size_t>(instance.node)] = true;
        }
    }
    for (const Body& body : physics.bodies)
        spoken[static_cast<size_t>(body.node)] = true;
    for (const Collider& collider : physics.colliders)
        spoken[static_cast<size_t>(collider.node)] = true;
    for (size_t n = 0; n < spoken.size(); ++n)
        if (const int parent = scene.nodes[n].parent; parent >= 0 && spoken[static_cast<size_t>(parent)])
            spoken[n] = true;
    return spoken;
}

} // namespace

void loosen(Scene& scene) {
    if (hasSoftBodies(scene)) {
        scene.warnings.push_back(
            {"", "is not made loose: it has soft bodies, which rigid bodies do not meet"});
        return;
    }
    auto physics =
        scene.physics != nullptr ? std::make_shared<Physics>(*scene.physics) : std::make_shared<Physics>();
    const std::vector<bool> spoken = spokenFor(scene, *physics);
    std::vector<std::vector<int>> meshes(scene.nodes.size());
    for (const Instance& instance : scene.instances)
        if (instance.node >= 0 && scene.meshes[static_cast<size_t>(instance.mesh)].triangleCount() > 0)
            meshes[static_cast<size_t>(instance.node)].push_back(instance.mesh);
    std::vector<int> bodyOf(scene.nodes.size(), -1);
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        const int parent = scene.nodes[n].parent;
        if (spoken[n])
            continue;
        if (parent >= 0)
            bodyOf[n] = bodyOf[static_cast<size_t>(parent)];
        if (meshes[n].empty())
            continue;
        if (bodyOf[n] < 0) {
            if (physics->bodies.size() >= kMaxBodies)
                continue;
            bodyOf[n] = static_cast<int>(physics->bodies.size());
            Body body;
            body.name = scene.nodes[n].name;
            body.node = static_cast<int>(n);
            body.mass = kMass;
            body.gravityFactor = 0.0;
            body.drag = kDrag;
            physics->bodies.push_back(std::move(body));
        }
        if (physics->colliders.size() >= kMaxColliders)
            continue;
        Collider collider;
        collider.node = static_cast<int>(n);
        collider.body = bodyOf[n];
        collider.shape = ColliderShape::Hull;
        collider.meshes = meshes[n];
        physics->colliders.push_back(std::move(collider));
    }
    physics->loose = true;
    if (!physics->bodies.empty())
        scene.physics = std::move(physics);
}

} // namespace touchstone
