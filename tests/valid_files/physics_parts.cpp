#include "tests/valid_files/physics_parts.h"

namespace touchstone::test {
namespace {

using nlohmann::json;

constexpr const char* kPhysics = "KHR_physics_rigid_bodies";

json& physicsOf(FileDraft& draft, size_t node) {
    return draft.maker.json["nodes"][node]["extensions"][kPhysics];
}

void addColliders(FileDraft& draft) {
    Draw& draw = draft.draw;
    json materials = json::array();
    for (size_t n = 1 + draw.below(2); n > 0; --n) {
        json material = {{"frictionCombine", "average"}, {"restitution", 0.5}};
        if (draw.chance(0.7))
            material["staticFriction"] = draw.real(0.0, 2.0);
        if (draw.chance(0.7))
            material["dynamicFriction"] = draw.real(0.0, 2.0);
        materials.push_back(material);
    }
    draft.maker.json["extensions"][kPhysics]["physicsMaterials"] = materials;
    for (const size_t node : draft.meshNodes)
        if (draw.chance(0.7))
            physicsOf(draft, node)["collider"] = {{"geometry", {{"node", node}}},
                                                  {"physicsMaterial", draw.below(materials.size())}};
}

json motion(Draw& draw) {
    json stated = json::object();
    if (draw.chance(0.2))
        stated["isKinematic"] = true;
    if (draw.chance(0.7))
        stated["mass"] = draw.pick(std::vector{0.001, 0.1, 5.0});
    if (draw.chance(0.3))
        stated["centerOfMass"] = {draw.real(-0.1, 0.1), 0.0, draw.real(-0.1, 0.1)};
    if (draw.chance(0.3))
        stated["linearVelocity"] = {draw.real(-1, 1), draw.real(-1, 1), 0.0};
    if (draw.chance(0.3))
        stated["angularVelocity"] = {0.0, draw.real(-9, 9), draw.real(-9, 9)};
    if (draw.chance(0.3))
        stated["gravityFactor"] = draw.pick(std::vector{0.0, 1.0, -0.5});
    return stated;
}

/// A shape of KHR_implicit_shapes.
json shape(Draw& draw) {
    switch (draw.below(4)) {
    case 0:
        return {{"type", "box"}, {"box", {{"size", {draw.real(0.01, 0.1), 0.05, draw.real(0.01, 0.1)}}}}};
    case 1:
        return {{"type", "sphere"}, {"sphere", {{"radius", draw.pick(std::vector{1e-6, 0.02, 0.5})}}}};
    case 2:
        return {{"type", "capsule"},
                {"capsule",
                 {{"height", draw.real(0.01, 0.1)},
                  {"radiusBottom", 0.0},
                  {"radiusTop", draw.real(0.01, 0.05)}}}};
    default:
        return {{"type", "cylinder"}, {"cylinder", json::object()}};
    }
}

/// What a body collides with: its hull, or a shape.
json geometry(FileDraft& draft, size_t node) {
    if (draft.draw.chance(0.6))
        return {{"node", node}, {"convexHull", true}};
    draft.use("KHR_implicit_shapes");
    json& shapes = draft.maker.json["extensions"]["KHR_implicit_shapes"]["shapes"];
    shapes.push_back(shape(draft.draw));
    return {{"shape", shapes.size() - 1}};
}

json filters(Draw& draw) {
    return {{{"collisionSystems", {"a"}}, {"collideWithSystems", {"a", "b"}}},
            {{"collisionSystems", {"b"}}, {"notCollideWithSystems", {draw.chance(0.5) ? "a" : "b"}}}};
}

/// One way or turn, with what TOUCHSTONE_joint adds: friction, detents, and a setting of the session.
json joint(Draw& draw) {
    const bool slides = draw.chance(0.5);
    json limits = json::array();
    for (const char* axes : {"linearAxes", "angularAxes"})
        for (const int axis : {0, 1, 2}) {
            const bool free = axis == 0 && slides == (std::string(axes) == "linearAxes");
            json limit = {{axes, {axis}}};
            limit["min"] = free ? draw.real(-0.1, 0.0) : 0.0;
            limit["max"] = free ? draw.real(0.0, 0.1) : 0.0;
            if (free && draw.chance(0.3)) {
                limit["stiffness"] = draw.real(10.0, 1000.0);
                limit["damping"] = draw.real(0.0, 5.0);
            }
            limits.push_back(limit);
        }
    json described = {{"limits", limits}};
    if (draw.chance(0.4))
        described["drives"] = {{{"type", slides ? "linear" : "angular"},
                                {"mode", draw.pick(std::vector<std::string>{"force", "acceleration"})},
                                {"axis", 0},
                                {"stiffness", draw.real(0.0, 100.0)},
                                {"damping", draw.real(0.0, 5.0)},
                                {"positionTarget", 0.0}}};
    json ours = json::object();
    if (draw.chance(0.5))
        ours["friction"] = draw.real(0.0, 0.5);
    if (draw.chance(0.5)) {
        ours["detents"] = {-0.05, 0.0, 0.02};
        ours["detentForce"] = draw.real(0.0, 1.0);
    }
    switch (draw.below(4)) {
    case 0:
        ours.update({{"setting", "stiffness"}, {"from", 100.0}, {"to", 900.0}});
        break;
    case 1:
        ours.update({{"setting", "forceShading"}, {"values", {"off", "on"}}, {"press", draw.chance(0.5)}});
        break;
    case 2:
        ours.update({{"setting", "of_another_program"}, {"from", 0.0}, {"to", 1.0}});
        break;
    default:
        break;
    }
    if (!ours.empty())
        described["extensions"]["TOUCHSTONE_joint"] = ours;
    return described;
}

void addBodies(FileDraft& draft) {
    Draw& draw = draft.draw;
    draft.maker.json["extensions"][kPhysics]["collisionFilters"] = filters(draw);
    json joints = json::array();
    for (const size_t node : draft.meshNodes) {
        if (!draw.chance(0.7))
            continue;
        json& stated = physicsOf(draft, node);
        stated["motion"] = motion(draw);
        if (draw.chance(0.7))
            stated["collider"]["geometry"] = geometry(draft, node);
        if (stated.contains("collider") && draw.chance(0.3))
            stated["collider"]["collisionFilter"] = draw.below(2);
        const size_t other = draft.meshNodes[draw.below(draft.meshNodes.size())];
        if (other == node || !draw.chance(0.5))
            continue;
        stated["joint"] = {{"connectedNode", other}, {"joint", joints.size()}};
        if (draw.chance(0.3))
            stated["joint"]["enableCollision"] = true;
        joints.push_back(joint(draw));
    }
    if (joints.empty())
        return;
    draft.maker.json["extensions"][kPhysics]["physicsJoints"] = joints;
    draft.use("TOUCHSTONE_joint");
}

} // namespace

void addPhysics(FileDraft& draft) {
    if (!draft.has(Feature::Physics) && !draft.has(Feature::Bodies))
        return;
    draft.use(kPhysics);
    if (draft.has(Feature::Physics))
        addColliders(draft);
    if (draft.has(Feature::Bodies))
        addBodies(draft);
}

} // namespace touchstone::test
