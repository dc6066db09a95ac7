#pragma once
// Scenes with rigid bodies, made in memory. Their frame is the workspace's: SI.

#include "engine/load/scene_loader.h"
#include "haptics/body/body_world.h"
#include "haptics/scene/haptic_scene.h"
#include "tests/support/gltf_maker.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

namespace touchstone::test {

inline constexpr const char* kPhysics = "KHR_physics_rigid_bodies";

struct BodyMaker : GltfMaker {
    /// A square of 1 m in the plane y = -10 m, out of everything's way, so that there is something to touch.
    BodyMaker() : GltfMaker(square()) {
        json["nodes"][0]["translation"] = {-0.5, -10.0, 0.5};
        json["nodes"][0]["rotation"] = {-std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
        json["extensionsUsed"] = {kPhysics, "KHR_implicit_shapes"};
    }

    size_t node(const std::string& name, const glm::dvec3& at, nlohmann::json rotation = {}) {
        nlohmann::json node{{"name", name}, {"translation", {at.x, at.y, at.z}}};
        if (!rotation.is_null())
            node["rotation"] = std::move(rotation);
        const size_t index = append("nodes", std::move(node));
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }
    size_t child(size_t parent, const std::string& name, const glm::dvec3& at, nlohmann::json rotation = {}) {
        const size_t index = node(name, at, std::move(rotation));
        json["scenes"][0]["nodes"].erase(json["scenes"][0]["nodes"].size() - 1);
        json["nodes"][parent]["children"].push_back(index);
        return index;
    }
    nlohmann::json& part(size_t node) { return json["nodes"][node]["extensions"][kPhysics]; }
    size_t shape(nlohmann::json shape) {
        json["extensions"]["KHR_implicit_shapes"]["shapes"].push_back(std::move(shape));
        return json["extensions"]["KHR_implicit_shapes"]["shapes"].size() - 1;
    }
    size_t surface(double friction, double restitution) {
        json["extensions"][kPhysics]["physicsMaterials"].push_back(
            {{"staticFriction", friction}, {"dynamicFriction", friction}, {"restitution", restitution}});
        return json["extensions"][kPhysics]["physicsMaterials"].size() - 1;
    }
    void box(size_t node, const glm::dvec3& size, size_t surface) {
        part(node)["collider"] = {
            {"geometry",
             {{"shape", shape({{"type", "box"}, {"box", {{"size", {size.x, size.y, size.z}}}}})}}},
            {"physicsMaterial", surface}};
    }
    void ball(size_t node, double radius, size_t surface) {
        part(node)["collider"] = {
            {"geometry", {{"shape", shape({{"type", "sphere"}, {"sphere", {{"radius", radius}}}})}}},
            {"physicsMaterial", surface}};
    }
    void motion(size_t node, nlohmann::json motion) { part(node)["motion"] = std::move(motion); }
    size_t joint(size_t base, size_t of, nlohmann::json description) {
        json["extensions"][kPhysics]["physicsJoints"].push_back(std::move(description));
        const size_t index = json["extensions"][kPhysics]["physicsJoints"].size() - 1;
        part(base)["joint"] = {{"connectedNode", of}, {"joint", index}};
        return index;
    }
    /// Locks all axes but those named (0 to 5).
    static nlohmann::json allBut(std::vector<int> free) {
        nlohmann::json limits = nlohmann::json::array();
        for (int axis = 0; axis < 6; ++axis)
            if (std::ranges::find(free, axis) == free.end())
                limits.push_back(
                    {{axis < 3 ? "linearAxes" : "angularAxes", {axis % 3}}, {"min", 0.0}, {"max", 0.0}});
        return {{"limits", limits}};
    }

    [[nodiscard]] ScenePtr scene() const { return loadSceneFromMemory(glb(), {}); }
};

/// A cube that is felt, and a body; one of mass 0 rests.
inline size_t addCube(BodyMaker& maker, const std::string& name, const glm::dvec3& at, double side,
                      double mass) {
    std::vector<float> positions;
    const auto half = static_cast<float>(0.5 * side);
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            positions.push_back((corner >> axis & 1) != 0 ? half : -half);
    const size_t accessor = maker.addAccessor<float>(positions, "VEC3");
    maker.json["accessors"][accessor]["min"] = {-half, -half, -half};
    maker.json["accessors"][accessor]["max"] = {half, half, half};
    const size_t indices = maker.addAccessor<uint16_t>({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                                        2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                                                       "SCALAR");
    const size_t mesh = maker.append(
        "meshes", {{"primitives", {{{"attributes", {{"POSITION", accessor}}}, {"indices", indices}}}}});
    const size_t node = maker.node(name, at);
    maker.json["nodes"][node]["mesh"] = mesh;
    maker.box(node, glm::dvec3(side), 0);
    if (mass > 0.0)
        maker.motion(node, {{"mass", mass}});
    return node;
}

inline const char* nameOf(BodyIntegrator integrator) {
    return integrator == BodyIntegrator::Explicit       ? "explicit"
           : integrator == BodyIntegrator::SemiImplicit ? "semiImplicit"
                                                        : "implicit";
}

/// The bodies of a scene without hands, step by step.
struct Bodies {
    explicit Bodies(const BodyMaker& maker) : Bodies(maker.scene()) {}
    explicit Bodies(ScenePtr loaded)
        : scene(std::move(loaded)),
          haptic(compileHapticScene(*scene, Similarity{}, {.rays = false, .progress = {}})),
          world(body::BodyWorld::make(*scene, *haptic)) {}

    void step(BodyIntegrator integrator = BodyIntegrator::SemiImplicit, double gravity = 9.81) {
        world->beginTick();
        world->integrate(integrator, gravity, dt);
        time += dt;
    }
    void run(double seconds, BodyIntegrator integrator = BodyIntegrator::SemiImplicit,
             double gravity = 9.81) {
        for (const double end = time + seconds - 0.5 * dt; time < end;)
            step(integrator, gravity);
    }
    [[nodiscard]] body::BodyState& at(const std::string& name) {
        for (size_t b = 0; b < world->names().size(); ++b)
            if (world->names()[b] == name)
                return world->states()[b];
        throw std::out_of_range(name);
    }

    ScenePtr scene;
    std::shared_ptr<const HapticScene> haptic;
    std::shared_ptr<body::BodyWorld> world;
    double dt = 1e-3, time = 0.0;
};

} // namespace touchstone::test
