// What a file states of bodies, in both forms of the draft; what is wrong is left out with a message.

#include "engine/save/material_patch.h"
#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace touchstone::test {

namespace {

/// A box on a node, as the file of a test starts.
BodyMaker oneBox() {
    BodyMaker maker;
    (void)maker.surface(0.4, 0.25);
    const size_t box = maker.node("box", {0.1, 0.2, 0.3});
    maker.box(box, {0.02, 0.04, 0.06}, 0);
    maker.motion(box, {{"mass", 0.5}, {"linearVelocity", {1.0, 2.0, 3.0}}, {"gravityFactor", 0.5}});
    return maker;
}

bool warns(const Scene& scene, const std::string& place, const std::string& message) {
    return std::ranges::any_of(scene.warnings, [&](const Warning& warning) {
        return warning.place.find(place) != std::string::npos &&
               warning.message.find(message) != std::string::npos;
    });
}

TEST(BodyImport, ReadsMassMotionAndMaterial) {
    Bodies bodies(oneBox());
    ASSERT_NE(bodies.world, nullptr);
    const Physics& physics = *bodies.scene->physics;
    ASSERT_EQ(physics.bodies.size(), 1u);
    EXPECT_EQ(physics.bodies[0].velocity, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(physics.materials[0].restitution, 0.25);
    EXPECT_NEAR(1.0 / bodies.world->masses()[0].inverse, 0.5, 1e-12);
    glm::dvec3 inertia = bodies.world->masses()[0].inertia; // of a box: m (b^2 + c^2) / 12
    std::vector<double> sorted{inertia.x, inertia.y, inertia.z};
    std::ranges::sort(sorted);
    EXPECT_NEAR(sorted[0], 0.5 * (4e-4 + 16e-4) / 12.0, 1e-9);
    EXPECT_NEAR(sorted[1], 0.5 * (4e-4 + 36e-4) / 12.0, 1e-9);
    EXPECT_NEAR(sorted[2], 0.5 * (16e-4 + 36e-4) / 12.0, 1e-9);
    for (const Warning& warning : bodies.scene->warnings)
        ADD_FAILURE() << warning.place << ": " << warning.message;
}

/// A cube of 2 cm as a mesh; its index.
size_t cubeMesh(BodyMaker& maker) {
    std::vector<float> positions;
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            positions.push_back((corner >> axis & 1) != 0 ? 0.01f : -0.01f);
    const size_t at = maker.addAccessor<float>(positions, "VEC3");
    maker.json["accessors"][at]["min"] = {-0.01, -0.01, -0.01};
    maker.json["accessors"][at]["max"] = {0.01, 0.01, 0.01};
    const size_t indices = maker.addAccessor<uint16_t>({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                                        2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                                                       "SCALAR");
    return maker.append("meshes",
                        {{"primitives", {{{"attributes", {{"POSITION", at}}}, {"indices", indices}}}}});
}

TEST(BodyImport, AColliderIsAShapeAMeshOrANode) {
    for (const std::string form : {"shape", "mesh", "node", "collision_shapes"}) {
        BodyMaker maker;
        const size_t mesh = cubeMesh(maker), body = maker.node("body", {0.0, 0.0, 0.0});
        maker.json["nodes"][body]["mesh"] = mesh;
        maker.motion(body, {{"mass", 0.1}});
        if (form == "shape")
            maker.part(body)["collider"]["geometry"]["shape"] =
                maker.shape({{"type", "box"}, {"box", {{"size", {0.02, 0.02, 0.02}}}}});
        else if (form == "collision_shapes") {
            maker.json["extensions"]["KHR_collision_shapes"]["shapes"] = {
                {{"type", "box"}, {"box", {{"size", {0.02, 0.02, 0.02}}}}}};
            maker.part(body)["collider"]["shape"] = 0;
        } else
            maker.part(body)["collider"]["geometry"] = {{form, form == "mesh" ? mesh : body},
                                                        {"convexHull", true}};
        const size_t floor = maker.node("floor", {0.0, -0.06, 0.0}); // its top is the cube's bottom
        maker.part(floor)["collider"]["geometry"]["shape"] =
            maker.shape({{"type", "box"}, {"box", {{"size", {1.0, 0.1, 1.0}}}}});
        Bodies bodies(maker);
        ASSERT_NE(bodies.world, nullptr) << form;
        ASSERT_EQ(bodies.scene->physics->colliders.size(), 2u) << form;
        EXPECT_NEAR(bodies.world->masses()[0].inertia.x, 0.1 * 4e-4 / 6.0, 1e-10) << form;
        bodies.run(0.5);
        EXPECT_NEAR(bodies.at("body").pose.position.y, 0.0, 1e-4) << form;
    }
}

TEST(BodyImport, WhatIsWrongIsLeftOutWithAMessage) {
    struct Case {
        const char* what;
        std::function<void(nlohmann::json& motion)> spoil;
        const char* place;
        const char* message;
    };
    const Case cases[] = {
        {"negative", [](auto& m) { m["mass"] = -1.0; }, "motion.mass", "out of range"},
        {"zero", [](auto& m) { m["mass"] = 0.0; }, "motion.mass", "infinite"},
        {"infinite", [](auto& m) { m["mass"] = 1e39; }, "motion.mass", "out of range"},
        {"text", [](auto& m) { m["mass"] = "heavy"; }, "motion.mass", "number"},
        {"triangle",
         [](auto& m) {
             m["inertiaDiagonal"] = {1.0, 1.0, 3.0};
         },
         "inertiaDiagonal", "no body"},
        {"inertia",
         [](auto& m) {
             m["inertiaDiagonal"] = {-1.0, 1.0, 1.0};
         },
         "inertiaDiagonal", "negative"},
        {"length",
         [](auto& m) {
             m["inertiaDiagonal"] = {1.0, 1.0};
         },
         "inertiaDiagonal", "array of 3"},
        {"turn",
         [](auto& m) {
             m["inertiaOrientation"] = {0.0, 0.0, 0.0, 0.0};
         },
         "inertiaOrientation", "no rotation"},
        {"velocity",
         [](auto& m) {
             m["linearVelocity"] = {1e35, 0.0, 0.0};
         },
         "linearVelocity", "no finite"},
        {"object", [](auto& m) { m = nlohmann::json::array(); }, "motion", "object"},
    };
    for (const Case& spoilt : cases) {
        BodyMaker maker = oneBox();
        const size_t other = maker.node("other", {0.0, 1.0, 0.0});
        maker.ball(other, 0.01, 0);
        maker.motion(other, {{"mass", 0.1}});
        spoilt.spoil(maker.part(1)["motion"]);
        Bodies bodies(maker);
        ASSERT_NE(bodies.world, nullptr) << spoilt.what;
        EXPECT_TRUE(warns(*bodies.scene, spoilt.place, spoilt.message)) << spoilt.what;
        bodies.run(0.05);
        for (const body::BodyState& state : bodies.world->states())
            EXPECT_TRUE(std::isfinite(glm::dot(state.pose.position, state.velocity))) << spoilt.what;
    }
}

TEST(BodyImport, JointsToNowhereAreLeftOut) {
    struct Case {
        std::function<void(nlohmann::json& joint, nlohmann::json& described)> spoil;
        const char* message;
    };
    const Case cases[] = {
        {[](auto& j, auto&) { j.erase("connectedNode"); }, "nowhere"},
        {[](auto& j, auto&) { j["connectedNode"] = 99; }, "refers to nodes[99]"},
        {[](auto& j, auto&) { j["connectedNode"] = 1; }, "same body"},
        {[](auto& j, auto&) { j["connectedNode"] = 0; }, ""},
        {[](auto& j, auto&) { j["joint"] = 7; }, "physicsJoints[7]"},
        {[](auto&, auto& d) {
             d["limits"] = {{{"linearAxes", {3}}, {"min", 0.0}}};
         },
         "not 0, 1 or 2"},
        {[](auto&, auto& d) {
             d["limits"] = {{{"linearAxes", {0}}, {"min", 1.0}, {"max", 0.0}}};
         },
         "above"},
        {[](auto&, auto& d) {
             d["drives"] = {{{"type", "sideways"}, {"axis", 0}}};
         },
         "neither linear"},
        {[](auto&, auto& d) {
             d["extensions"]["TOUCHSTONE_joint"] = {{"pitch", 0.0}};
         },
         "thread"},
        {[](auto&, auto& d) {
             d["extensions"]["TOUCHSTONE_joint"] = {{"detents", {1.0, 0.0}}};
         },
         "ascend"},
    };
    for (const Case& spoilt : cases) {
        BodyMaker maker = oneBox();
        const size_t anchor = maker.node("anchor", {0.1, 0.2, 0.3});
        (void)maker.joint(1, anchor, BodyMaker::allBut({0, 3}));
        spoilt.spoil(maker.part(1)["joint"], maker.json["extensions"][kPhysics]["physicsJoints"][0]);
        Bodies bodies(maker);
        ASSERT_NE(bodies.world, nullptr) << spoilt.message;
        const bool good = std::string(spoilt.message).empty();
        EXPECT_EQ(bodies.world->solver().joints().size(), good ? 1u : 0u) << spoilt.message;
        if (!good) {
            EXPECT_TRUE(warns(*bodies.scene, "", spoilt.message)) << spoilt.message;
        }
        bodies.run(0.05);
    }
}

TEST(BodyImport, AHundredThousandBodiesAreTooMany) {
    BodyMaker maker;
    const size_t ball = maker.shape({{"type", "sphere"}, {"sphere", {{"radius", 0.001}}}});
    nlohmann::json nodes = maker.json["nodes"];
    nlohmann::json& roots = maker.json["scenes"][0]["nodes"];
    for (int i = 0; i < 100'000; ++i) {
        nlohmann::json node{{"translation", {0.01 * (i % 100), 0.01 * (i / 100 % 100), 0.01 * (i / 10000)}}};
        node["extensions"][kPhysics] = {{"motion", {{"mass", 0.001}}},
                                        {"collider", {{"geometry", {{"shape", ball}}}}}};
        roots.push_back(nodes.size());
        nodes.push_back(std::move(node));
    }
    maker.json["nodes"] = std::move(nodes);
    Bodies bodies(maker);
    ASSERT_NE(bodies.world, nullptr);
    EXPECT_EQ(bodies.scene->physics->bodies.size(), kMaxBodies);
    EXPECT_TRUE(warns(*bodies.scene, "motion", "beyond the 2048 bodies"));
    EXPECT_EQ(bodies.world->awake(), body::kMaxAwake);
    bodies.run(0.004);
}

TEST(BodyImport, BodiesThatBeginInsideEachOtherComeApartGently) {
    BodyMaker maker;
    (void)maker.surface(0.5, 0.0);
    maker.box(maker.node("floor", {0.0, -0.05, 0.0}), {1.0, 0.1, 1.0}, 0);
    for (int i = 0; i < 5; ++i) {
        const size_t box = maker.node("box", {0.001 * i, 0.005 + 0.0005 * i, 0.0});
        maker.box(box, {0.02, 0.02, 0.02}, 0);
        maker.motion(box, {{"mass", 0.05}});
    }
    Bodies bodies(maker);
    double fastest = 0.0;
    while (bodies.time < 2.0) {
        bodies.step();
        for (const body::BodyState& state : bodies.world->states())
            fastest = std::max(fastest, glm::length(state.velocity));
    }
    EXPECT_LT(fastest, 1.0);
}

TEST(BodyImport, WithoutMotionThereIsNoPhysics) {
    BodyMaker maker;
    (void)maker.surface(0.9, 0.0);
    maker.box(maker.node("floor", {0.0, 0.0, 0.0}), {1.0, 1.0, 1.0}, 0);
    EXPECT_EQ(maker.scene()->physics, nullptr);
}

TEST(BodyImport, BodiesAreKeptWhenMaterialsAreSaved) {
    BodyMaker maker = oneBox();
    maker.json["materials"] = {{{"name", "wood"}}};
    maker.json["meshes"][0]["primitives"][0]["material"] = 0;
    const std::vector<uint8_t> saved =
        withMaterials(maker.glb(), patchesFrom(R"({"0": {"stiffness": 500}})"), "saved.glb");
    const ScenePtr scene = loadSceneFromMemory(saved, {});
    ASSERT_NE(scene->physics, nullptr);
    EXPECT_NEAR(*scene->physics->bodies.at(0).mass, 0.5, 1e-12);
    EXPECT_EQ(scene->physics->colliders.size(), 1u);
}

} // namespace

} // namespace touchstone::test
