// Skinned meshes in the pose of their joints, against the specification evaluated independently.
#include "engine/scene/animation.h"
#include "tests/unit/engine/static_pose/pose_support.h"

namespace touchstone::skin_test {
namespace {

using namespace test;

/// Joints far from where the mesh was bound, turned and scaled unevenly; the mesh's node somewhere else.
Beam posedBeam() {
    Beam beam;
    beam.node(0)["translation"] = {100.0, 0.0, 0.0};
    beam.node(0)["scale"] = {7.0, 7.0, 7.0};
    beam.node(1)["translation"] = {-2.0, 3.0, 1.0};
    beam.node(1)["rotation"] = {0.0, std::sin(0.4), 0.0, std::cos(0.4)};
    beam.node(2)["scale"] = {1.0, 2.0, 0.5};
    beam.bend(1.1);
    return beam;
}

TEST(Skin, FollowsItsJointsAndNotItsNode) {
    const ScenePtr scene = expectPose(posedBeam().maker);
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message;
    EXPECT_LT(scene->bounds.high.x, 10.0);
    EXPECT_FALSE(scene->instances[0].followsNode);
}

TEST(Skin, InItsBindPoseIsAsModelled) {
    Beam beam;
    const ScenePtr scene = expectPose(beam.maker);
    EXPECT_NEAR(glm::distance(scene->bounds.low, glm::dvec3(0.0)), 0.0, 1e-7);
    EXPECT_NEAR(glm::distance(scene->bounds.high, glm::dvec3(1.0, 2.0, 1.0)), 0.0, 1e-7);
}

TEST(Skin, WithoutInverseBindMatricesTakesTheIdentity) {
    Beam beam = posedBeam();
    beam.maker.json["skins"][0].erase("inverseBindMatrices");
    expectPose(beam.maker);
}

TEST(Skin, TakesEveryTypeOfJointsAndWeights) {
    const auto withTypes = [](auto jointSample, auto weightSample) {
        using Joint = decltype(jointSample);
        using Weight = decltype(weightSample);
        Beam beam = posedBeam();
        std::vector<Joint> joints;
        std::vector<Weight> weights;
        for (size_t v = 0; v < beam.vertices; ++v) {
            joints.insert(joints.end(), {1, 0, 1, 1});
            if constexpr (std::is_floating_point_v<Weight>) {
                weights.insert(weights.end(), {0.25f, 0.75f, 0.0f, 0.0f});
            } else {
                const Weight all = std::numeric_limits<Weight>::max(), part = all / 5;
                weights.insert(weights.end(), {part, static_cast<Weight>(all - part), 0, 0});
            }
        }
        beam.primitiveAttributes()["JOINTS_0"] = beam.maker.addAccessor(joints, "VEC4");
        beam.primitiveAttributes()["WEIGHTS_0"] =
            beam.maker.addAccessor(weights, "VEC4", !std::is_floating_point_v<Weight>);
        const ScenePtr scene = expectPose(beam.maker);
        EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message;
    };
    withTypes(uint8_t{}, float{});
    withTypes(uint8_t{}, uint8_t{});
    withTypes(uint16_t{}, uint16_t{});
    withTypes(uint16_t{}, float{});
}

TEST(Skin, SumsSeveralSetsOfInfluences) {
    Beam beam = posedBeam();
    std::vector<uint8_t> joints(4 * beam.vertices, 1);
    std::vector<float> first, second;
    for (size_t v = 0; v < beam.vertices; ++v) {
        first.insert(first.end(), {0.1f, 0.2f, 0.1f, 0.1f});
        second.insert(second.end(), {0.0f, 0.3f, 0.0f, 0.2f});
    }
    beam.primitiveAttributes()["WEIGHTS_0"] = beam.maker.addAccessor(first, "VEC4");
    beam.primitiveAttributes()["JOINTS_1"] = beam.maker.addAccessor(joints, "VEC4");
    beam.primitiveAttributes()["WEIGHTS_1"] = beam.maker.addAccessor(second, "VEC4");
    const ScenePtr scene = expectPose(beam.maker);
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message;
}

TEST(Skin, WithoutNormalsGetsThoseOfThePosedTriangles) {
    Beam beam = posedBeam();
    beam.primitiveAttributes().erase("NORMAL");
    const ScenePtr scene = expectPose(beam.maker);
    EXPECT_FALSE(scene->meshes[0].normalsFromFile);
}

TEST(Skin, MirroredByItsJointsStaysTurnedOutwards) {
    Beam beam = posedBeam();
    beam.node(1)["scale"] = {-1.0, 1.5, 1.0};
    const ScenePtr scene = expectPose(beam.maker);
    // Outwards by the order of the corners as by the normals.
    const Mesh& mesh = scene->meshes[0];
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::vec3 &a = mesh.positions[mesh.indices[i]], &b = mesh.positions[mesh.indices[i + 1]],
                        &c = mesh.positions[mesh.indices[i + 2]];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), mesh.normals[mesh.indices[i]]), 0.0f);
    }
}

TEST(Skin, TurnsTangentsAndTheirHandWithTheSurface) {
    for (const double mirror : {1.0, -1.0}) {
        Beam beam;
        GltfMaker& maker = beam.maker;
        std::vector<float> tangents, uv;
        for (size_t v = 0; v < beam.vertices; ++v) {
            tangents.insert(tangents.end(), {0.0f, 1.0f, 0.0f, 1.0f});
            uv.insert(uv.end(), {0.0f, static_cast<float>(v)});
        }
        beam.primitiveAttributes()["TANGENT"] = maker.addAccessor(tangents, "VEC4");
        beam.primitiveAttributes()["TEXCOORD_0"] = maker.addAccessor(uv, "VEC2");
        maker.append("images", {{"uri", "nowhere.png"}});
        maker.append("textures", {{"source", 0}});
        maker.append("materials", {{"normalTexture", {{"index", 0}}}});
        maker.primitive()["material"] = 0;
        beam.node(1)["scale"] = {mirror, 3.0, 1.0};
        beam.node(1)["rotation"] = {0.0, 0.0, std::sin(0.3), std::cos(0.3)};
        const ScenePtr scene = expectPose(maker);
        const Mesh& mesh = scene->meshes[0];
        ASSERT_TRUE(mesh.tangentsFromFile);
        // Both joints stand alike, so that the matrix is theirs at every vertex: y goes to the turned y.
        for (const glm::vec4& tangent : mesh.tangents) {
            EXPECT_NEAR(tangent.x, -std::sin(0.6), 1e-6);
            EXPECT_NEAR(tangent.y, std::cos(0.6), 1e-6);
            EXPECT_EQ(tangent.w, static_cast<float>(mirror));
        }
    }
}

TEST(Skin, IsSharedBySeveralNodesAndMeshes) {
    Beam beam = posedBeam();
    beam.maker.append("meshes", beam.maker.json["meshes"][0]);
    for (const int mesh : {0, 1}) {
        beam.maker.show(static_cast<size_t>(mesh));
        beam.maker.json["nodes"].back()["skin"] = 0;
        beam.maker.json["nodes"].back()["translation"] = {5.0, 5.0, 5.0};
    }
    const ScenePtr scene = expectPose(beam.maker);
    EXPECT_EQ(scene->instances.size(), 3u);
    EXPECT_EQ(scene->meshes.size(), 2u) << "nodes that show the same mesh in the same pose share it";
}

TEST(Skin, AndAnUnskinnedNodeShowTheSameMesh) {
    Beam beam = posedBeam();
    beam.maker.show(0);
    beam.maker.json["nodes"].back()["translation"] = {5.0, 5.0, 5.0};
    Beam two = beam;
    two.maker.append("skins", {{"joints", {2, 1}}});
    two.maker.show(0);
    two.maker.json["nodes"].back()["skin"] = 1;
    EXPECT_EQ(expectPose(beam.maker)->meshes.size(), 2u);
    EXPECT_EQ(expectPose(two.maker)->meshes.size(), 3u);
}

TEST(Skin, TakesMorphedVertices) {
    Beam beam = posedBeam();
    std::vector<float> moved, bent;
    for (size_t v = 0; v < beam.vertices; ++v) {
        moved.insert(moved.end(), {0.0f, 0.3f * static_cast<float>(v % 3), 0.1f});
        bent.insert(bent.end(), {0.2f, 0.1f * static_cast<float>(v % 2), 0.0f});
    }
    beam.maker.primitive()["targets"] = {{{"POSITION", beam.maker.addAccessor(moved, "VEC3")},
                                          {"NORMAL", beam.maker.addAccessor(bent, "VEC3")}}};
    beam.maker.json["meshes"][0]["weights"] = {0.8};
    expectPose(beam.maker);
}

TEST(Skin, TakesJointsOutsideOfTheScene) {
    Beam beam = posedBeam();
    beam.maker.json["scenes"][0]["nodes"] = {0};
    EXPECT_TRUE(warns(*expectPose(beam.maker), "skins[0]", "2 of its joints are not in the scene"));
}

TEST(Skin, TakesJointsWithoutACommonRoot) {
    Beam beam = posedBeam();
    beam.node(1).erase("children");
    beam.maker.json["scenes"][0]["nodes"].push_back(2);
    EXPECT_TRUE(warns(*expectPose(beam.maker), "skins[0]", "no common root"));
}

TEST(Skin, FollowsAJointThatIsItsOwnNodeOrOneWithAMesh) {
    Beam beam = posedBeam();
    beam.maker.json["skins"][0]["joints"] = {0, 2};
    beam.maker.json["skins"][0].erase("inverseBindMatrices");
    beam.node(0)["rotation"] = {std::sin(0.2), 0.0, 0.0, std::cos(0.2)};
    beam.node(0)["scale"] = {1.0, 1.0, 1.0};
    expectPose(beam.maker);
}

TEST(Skin, StandsExactlyFarFromTheOrigin) {
    Beam beam = posedBeam();
    beam.node(1)["translation"] = {1e6, -2e6, 3e6};
    const ScenePtr scene =
        expectPose(beam.maker); // 1e-5 of the size; floats in the scene's frame are 0.25 m off
    const TruthFile file = truthFile(beam.maker);
    EXPECT_LT(compare(evaluatePose(file), objectsOf(*scene)).position, 1e-6L);
}

TEST(Skin, OfAFlatNodeIsShown) {
    Beam beam = posedBeam();
    beam.node(0)["scale"] = {0.0, 0.0, 0.0};
    EXPECT_EQ(expectPose(beam.maker)->instances.size(), 1u);
}

TEST(Skin, OfAJointScaledToNothingIsFinite) {
    Beam beam = posedBeam();
    beam.node(2)["scale"] = {0.0, 0.0, 0.0};
    const ScenePtr scene = load(beam.maker);
    for (const glm::vec3& normal : scene->meshes[0].normals)
        EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
    beam.node(1)["scale"] = {0.0, 0.0, 0.0};
    EXPECT_NO_THROW((void)load(beam.maker)); // all of it in one point
}

TEST(Skin, OfAnimatedJointsKeepsItsPoseWithOneWarning) {
    Beam beam = posedBeam();
    beam.maker.show(0); // rigid, below the animated joint
    beam.maker.json["scenes"][0]["nodes"].erase(2);
    beam.node(2)["children"] = {3};
    const size_t times = addTimes(beam.maker),
                 places = beam.maker.addAccessor<float>({0, 1, 0, 4, 1, 0}, "VEC3");
    beam.maker.append("animations",
                      {{"samplers", {{{"input", times}, {"output", places}}}},
                       {"channels",
                        {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
                         {{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}});
    const ScenePtr scene = load(beam.maker);
    EXPECT_TRUE(scene->warnings.empty()) << warningsOf(*scene);
    ASSERT_EQ(scene->instances.size(), 2u);
    const auto at = sceneFromMeshAt(*scene, scene->animations.data(), 1.0);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(at[i] == scene->instances[i].sceneFromMesh, !scene->instances[i].followsNode) << i;
}

} // namespace
} // namespace touchstone::skin_test
