// EXT_mesh_gpu_instancing, against the specification evaluated independently.
#include "engine/import/file/import_context.h"
#include "engine/scene/animation.h"
#include "tests/unit/engine/static_pose/pose_support.h"

namespace touchstone::instancing_test {
namespace {

using namespace test;

const char* const kPlace = "nodes[0].extensions.EXT_mesh_gpu_instancing";

nlohmann::json& attributes(GltfMaker& maker, size_t node = 0) {
    return maker.json["nodes"][node]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

/// Three copies of the square on a node that stands askew.
GltfMaker copiedSquare() {
    GltfMaker maker = GltfMaker::square();
    maker.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    maker.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    maker.json["nodes"][0]["translation"] = {1.0, 2.0, 3.0};
    maker.json["nodes"][0]["rotation"] = {0.0, std::sin(0.3), 0.0, std::cos(0.3)};
    maker.json["nodes"][0]["scale"] = {1.0, 2.0, 0.5};
    attributes(maker)["TRANSLATION"] = maker.addAccessor<float>({0, 0, 0, 2, 0, 0, 0, 3, 1}, "VEC3");
    return maker;
}

TEST(Instancing, PlacesEveryCopy) {
    GltfMaker maker = copiedSquare();
    EXPECT_EQ(expectPose(maker)->instances.size(), 3u);
    attributes(maker)["SCALE"] = maker.addAccessor<float>({1, 1, 1, -1, 2, 1, 0.5f, 0.5f, 3}, "VEC3");
    expectPose(maker);
    attributes(maker)["ROTATION"] =
        maker.addAccessor<float>({0, 0, 0, 1, 0.5f, 0.5f, 0.5f, 0.5f, 0, 0, 0.6f, 0.8f}, "VEC4");
    const ScenePtr scene = expectPose(maker);
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings[0].message;
    EXPECT_EQ(scene->meshes.size(), 1u);
}

TEST(Instancing, TakesNormalisedRotationsAlone) {
    GltfMaker maker = copiedSquare();
    attributes(maker).erase("TRANSLATION");
    attributes(maker)["ROTATION"] =
        maker.addAccessor<int16_t>({0, 0, 0, 32767, 0, 19660, 0, 26214}, "VEC4", true);
    EXPECT_EQ(expectPose(maker)->instances.size(), 2u);
    attributes(maker)["ROTATION"] = maker.addAccessor<int8_t>({-127, 0, 0, 0, 0, 76, 0, 102}, "VEC4", true);
    EXPECT_EQ(expectPose(maker)->instances.size(), 2u);
}

TEST(Instancing, IgnoresAttributesOfItsOwn) {
    GltfMaker maker = copiedSquare();
    attributes(maker)["_ID"] = maker.addAccessor<uint16_t>({1, 2, 3, 4}, "SCALAR");
    attributes(maker)["_COLOR"] = 9999;
    expectPose(maker);
    attributes(maker).erase("TRANSLATION");
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->instances.size(), 1u);
    EXPECT_TRUE(warns(*scene, kPlace, "the mesh is placed once"));
}

TEST(Instancing, DoesNotMoveChildren) {
    GltfMaker maker = copiedSquare();
    maker.append("nodes", {{"mesh", 0}});
    maker.json["nodes"][0]["children"] = {1};
    EXPECT_EQ(expectPose(maker)->instances.size(), 4u);
}

TEST(Instancing, OfAnAnimatedNodeMovesEveryCopy) {
    GltfMaker maker = copiedSquare();
    const size_t times = addTimes(maker), places = maker.addAccessor<float>({1, 2, 3, 11, 2, 3}, "VEC3");
    maker.append("animations",
                 {{"samplers", {{{"input", times}, {"output", places}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    const ScenePtr scene = expectPose(maker);
    const auto moved = sceneFromMeshAt(*scene, scene->animations.data(), 1.0);
    for (size_t i = 0; i < 3; ++i) {
        glm::dmat4 expected = scene->instances[i].sceneFromMesh;
        expected[3].x += 10.0;
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(glm::distance(moved[i][c], expected[c]), 0.0, 1e-12);
    }
}

TEST(Instancing, OfASkinnedNodeDisplacesThePosedMesh) {
    Beam beam;
    beam.bend(0.8);
    beam.node(1)["translation"] = {0.0, 0.0, 2.0};
    beam.node(0)["scale"] = {2.0, 2.0, 2.0};
    beam.node(0)["rotation"] = {0.0, std::sin(0.3), 0.0, std::cos(0.3)};
    attributes(beam.maker)["TRANSLATION"] = beam.maker.addAccessor<float>({0, 0, 0, 5, 0, 0}, "VEC3");
    attributes(beam.maker)["SCALE"] = beam.maker.addAccessor<float>({1, 1, 1, 1, -2, 1}, "VEC3");
    const ScenePtr scene = expectPose(beam.maker);
    EXPECT_EQ(scene->meshes.size(), 1u);
    // The first copy stands where the skin itself stands.
    Beam alone = beam;
    alone.node(0).erase("extensions");
    const ScenePtr one = load(alone.maker);
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(glm::distance(scene->instances[0].sceneFromMesh[c], one->instances[0].sceneFromMesh[c]),
                    0.0, 1e-12);
    beam.node(0)["scale"] = {0.0, 0.0, 0.0};
    EXPECT_TRUE(warns(*load(beam.maker), "nodes[0]", "in a frame that is flat"));
}

TEST(Instancing, LeavesOutCopiesScaledToNothing) {
    GltfMaker maker = copiedSquare();
    attributes(maker)["SCALE"] = maker.addAccessor<float>({1, 1, 1, 0, 0, 0, 1, 0, 1}, "VEC3");
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->instances.size(), 1u);
    EXPECT_TRUE(warns(*scene, "nodes[0]", "2 of its copies are scaled to nothing"));
}

TEST(Instancing, BrokenAttributes) {
    GltfMaker counts = copiedSquare();
    attributes(counts)["SCALE"] = counts.addAccessor<float>({1, 1, 1}, "VEC3");
    EXPECT_REFUSED(counts, std::string(kPlace) + ".attributes.SCALE",
                   "has 1 copies where another attribute has 3");
    GltfMaker type = copiedSquare();
    attributes(type)["ROTATION"] = attributes(type)["TRANSLATION"];
    EXPECT_REFUSED(type, std::string(kPlace) + ".attributes.ROTATION", "should have 4 components");
    GltfMaker nan = copiedSquare();
    attributes(nan)["TRANSLATION"] = nan.addAccessor<float>({0, 0, 0, 0, NAN, 0}, "VEC3");
    EXPECT_REFUSED(nan, std::string(kPlace) + ".attributes.TRANSLATION", "copy 1 is not a finite number");
    GltfMaker missing = copiedSquare();
    attributes(missing)["TRANSLATION"] = 99;
    EXPECT_REFUSED(missing, std::string(kPlace) + ".attributes.TRANSLATION", "refers to accessors[99]");
    GltfMaker none = copiedSquare();
    none.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = nlohmann::json::object();
    EXPECT_REFUSED(none, kPlace, "'attributes'");
    GltfMaker turned = copiedSquare();
    attributes(turned)["ROTATION"] = turned.addAccessor<float>(std::vector<float>(12, 0.0f), "VEC4");
    EXPECT_TRUE(warns(*load(turned), kPlace, "3 rotations are quaternions of length 0"));
    GltfMaker far = copiedSquare();
    far.json["nodes"][0]["scale"] = {1e300, 1e300, 1e300};
    attributes(far)["SCALE"] = far.addAccessor<float>(std::vector<float>(9, 1e30f), "VEC3");
    EXPECT_REFUSED(far, "nodes[0]", "beyond what numbers can hold");
}

TEST(Instancing, CopiesOfLittleDataAreBounded) {
    const auto copies = [](size_t count) {
        GltfMaker maker = copiedSquare();
        attributes(maker)["TRANSLATION"] =
            maker.append("accessors", {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
        return maker;
    };
    EXPECT_TRUE(load(copies(0))->instances.empty());
    EXPECT_EQ(load(copies(kFreeCopies))->instances.size(), kFreeCopies);
    EXPECT_REFUSED(copies(kFreeCopies + 1), kPlace, "places more than 10000 copies");
    EXPECT_REFUSED(copies(2'000'000'000), kPlace, "places more than 10000 copies");
    // Nor by many nodes.
    GltfMaker many = copies(kFreeCopies);
    many.show(0);
    many.json["nodes"][1] = many.json["nodes"][0];
    EXPECT_REFUSED(many, "nodes[1].extensions.EXT_mesh_gpu_instancing", "places more than 10000 copies");
}

} // namespace
} // namespace touchstone::instancing_test
