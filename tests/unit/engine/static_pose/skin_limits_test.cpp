// Broken skins: refused where the geometry would be wrong, mended with a warning where it is not.
#include "tests/unit/engine/static_pose/pose_support.h"

#include <chrono>

namespace touchstone::skin_limits_test {
namespace {

using namespace test;

const char* const kPrimitive = "meshes[0].primitives[0]";

TEST(SkinLimits, StructureIsChecked) {
    Beam noSkin;
    noSkin.node(0)["skin"] = 1;
    EXPECT_REFUSED(noSkin.maker, "nodes[0].skin", "refers to skins[1]");
    Beam noJoint;
    noJoint.maker.json["skins"][0]["joints"] = {1, 3};
    EXPECT_REFUSED(noJoint.maker, "skins[0].joints[1]", "refers to nodes[3]");
    Beam noJoints;
    noJoints.maker.json["skins"][0].erase("joints");
    EXPECT_REFUSED(noJoints.maker, "skins[0]", "'joints' is missing");
    Beam empty;
    empty.maker.json["skins"][0]["joints"] = nlohmann::json::array();
    EXPECT_REFUSED(empty.maker, "skins[0].joints", "nothing to follow");
    Beam noAccessor;
    noAccessor.maker.json["skins"][0]["inverseBindMatrices"] = 99;
    EXPECT_REFUSED(noAccessor.maker, "skins[0].inverseBindMatrices", "refers to accessors[99]");
    Beam loop;
    loop.node(2)["children"] = {1};
    EXPECT_REFUSED(loop.maker, "nodes[1].children", "loop");
}

TEST(SkinLimits, InverseBindMatricesThatDoNotFitAreRefused) {
    Beam few;
    few.maker.json["skins"][0]["inverseBindMatrices"] = few.matrices({glm::mat4(1.0f)});
    EXPECT_REFUSED(few.maker, "skins[0].inverseBindMatrices", "has 1 matrices where 2 are needed");
    Beam type;
    type.maker.json["skins"][0]["inverseBindMatrices"] = 0;
    EXPECT_REFUSED(type.maker, "skins[0].inverseBindMatrices", "MAT4");
    Beam broken;
    glm::mat4 nan(1.0f);
    nan[1][1] = std::numeric_limits<float>::quiet_NaN();
    broken.maker.json["skins"][0]["inverseBindMatrices"] = broken.matrices({glm::mat4(1.0f), nan});
    EXPECT_REFUSED(broken.maker, kPrimitive, "has no finite place in the pose of skins[0]");
}

TEST(SkinLimits, BrokenMatricesOfUnusedJointsDoNotMatter) {
    Beam beam;
    glm::mat4 nan(1.0f);
    nan[1][1] = std::numeric_limits<float>::quiet_NaN();
    beam.maker.json["skins"][0]["joints"] = {1, 2, 2};
    beam.maker.json["skins"][0]["inverseBindMatrices"] =
        beam.matrices({glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), {0, -1, 0}), nan});
    const ScenePtr scene = load(beam.maker);
    EXPECT_NEAR(glm::distance(scene->bounds.high, glm::dvec3(1.0, 2.0, 1.0)), 0.0, 1e-6);
}

TEST(SkinLimits, MatricesThatAreNotAffineAreMended) {
    Beam beam;
    glm::mat4 odd(1.0f);
    odd[0][3] = 0.5f;
    odd[3][3] = 2.0f;
    beam.maker.json["skins"][0]["inverseBindMatrices"] =
        beam.matrices({odd, glm::translate(glm::mat4(1.0f), {0, -1, 0})});
    const ScenePtr scene = load(beam.maker);
    EXPECT_TRUE(warns(*scene, "skins[0].inverseBindMatrices", "1 matrices are not affine"));
    EXPECT_NEAR(glm::distance(scene->bounds.high, glm::dvec3(1.0, 2.0, 1.0)), 0.0, 1e-6);
}

TEST(SkinLimits, JointsOutOfRangeAreRefusedWhereTheyWeigh) {
    Beam beam;
    std::vector<uint8_t> joints(4 * beam.vertices, 0);
    joints[3] = 7; // of no weight
    beam.primitiveAttributes()["JOINTS_0"] = beam.maker.addAccessor(joints, "VEC4");
    EXPECT_NO_THROW((void)load(beam.maker));
    joints[5] = 2;
    beam.primitiveAttributes()["JOINTS_0"] = beam.maker.addAccessor(joints, "VEC4");
    std::vector<float> weights;
    for (size_t v = 0; v < beam.vertices; ++v)
        weights.insert(weights.end(), {0.5f, 0.5f, 0.0f, 0.0f});
    beam.primitiveAttributes()["WEIGHTS_0"] = beam.maker.addAccessor(weights, "VEC4");
    EXPECT_REFUSED(beam.maker, std::string(kPrimitive) + ".attributes.JOINTS_0", "vertex 1 follows joint 2");
}

TEST(SkinLimits, HalfAPairOfAttributesIsRefused) {
    Beam noWeights;
    noWeights.primitiveAttributes().erase("WEIGHTS_0");
    EXPECT_REFUSED(noWeights.maker, std::string(kPrimitive) + ".attributes", "has JOINTS_0 but no WEIGHTS_0");
    Beam noJoints;
    noJoints.primitiveAttributes()["WEIGHTS_1"] = noJoints.primitiveAttributes()["WEIGHTS_0"];
    EXPECT_REFUSED(noJoints.maker, std::string(kPrimitive) + ".attributes", "has WEIGHTS_1 but no JOINTS_1");
    Beam gap; // a set behind a gap in the numbering was left out
    gap.primitiveAttributes()["JOINTS_2"] = gap.primitiveAttributes()["JOINTS_0"];
    gap.primitiveAttributes()["WEIGHTS_2"] = gap.primitiveAttributes()["WEIGHTS_0"];
    EXPECT_REFUSED(gap.maker, std::string(kPrimitive) + ".attributes", "has JOINTS_2 but no JOINTS_1");
    Beam normalized;
    normalized.maker.json["accessors"][2]["normalized"] = true;
    EXPECT_REFUSED(normalized.maker, std::string(kPrimitive) + ".attributes.JOINTS_0", "normalized");
    // Without a skin nobody asks for them.
    noWeights.node(0).erase("skin");
    EXPECT_NO_THROW((void)load(noWeights.maker));
}

TEST(SkinLimits, APrimitiveWithoutJointsIsRigid) {
    Beam beam;
    beam.primitiveAttributes().erase("WEIGHTS_0");
    beam.primitiveAttributes().erase("JOINTS_0");
    beam.node(0)["translation"] = {3.0, 0.0, 0.0};
    const ScenePtr scene = expectPose(beam.maker);
    EXPECT_TRUE(warns(*scene, kPrimitive, "has no JOINTS_0 and WEIGHTS_0 for skins[0]"));
    EXPECT_TRUE(scene->instances[0].followsNode);
}

TEST(SkinLimits, OddWeightsAreMended) {
    const auto weighted = [](std::array<float, 4> weights) {
        Beam beam;
        beam.bend(1.0);
        std::vector<float> all;
        for (size_t v = 0; v < beam.vertices; ++v)
            all.insert(all.end(), weights.begin(), weights.end());
        beam.primitiveAttributes()["WEIGHTS_0"] = beam.maker.addAccessor(all, "VEC4");
        return beam.maker;
    };
    const std::string place = std::string(kPrimitive) + ".attributes.WEIGHTS_0";
    EXPECT_TRUE(warns(*expectPose(weighted({1.0f, 3.0f, 0.0f, 0.0f})), place, "whose sum is not 1"));
    EXPECT_TRUE(warns(*expectPose(weighted({1e-20f, 1e-20f, 0.0f, 0.0f})), place, "whose sum is not 1"));
    const ScenePtr negative = load(weighted({1.0f, -0.5f, 0.0f, 0.0f}));
    EXPECT_TRUE(warns(*negative, place, "negative and count as 0"));
    const ScenePtr none = load(weighted({0.0f, 0.0f, 0.0f, 0.0f}));
    EXPECT_TRUE(warns(*none, place, "follow their first joint"));
    for (const ScenePtr& scene : {negative, none}) // all of it follows joint 0, which is not moved
        EXPECT_NEAR(glm::distance(scene->bounds.high, glm::dvec3(1.0, 2.0, 1.0)), 0.0, 1e-6);
    EXPECT_REFUSED(weighted({NAN, 0.0f, 0.0f, 0.0f}), place, "not a finite number");
}

TEST(SkinLimits, PlacesBeyondFloatsAreRefused) {
    Beam beam;
    beam.node(2)["scale"] = {1e200, 1e200, 1e200};
    EXPECT_REFUSED(beam.maker, kPrimitive, "has no finite place in the pose of skins[0]");
    Beam over;
    over.node(1)["scale"] = {1e300, 1e300, 1e300};
    over.node(2)["scale"] = {1e300, 1e300, 1e300};
    EXPECT_REFUSED(over.maker, kPrimitive, "has no finite place in the pose of skins[0]");
}

TEST(SkinLimits, AHundredThousandJointsInAChain) {
    Beam beam;
    constexpr size_t kJoints = 100'000;
    nlohmann::json joints = {1, 2};
    beam.node(2)["children"] = {3};
    for (size_t j = 3; j <= kJoints; ++j) {
        beam.maker.append("nodes",
                          j < kJoints ? nlohmann::json{{"children", {j + 1}}} : nlohmann::json::object());
        joints.push_back(j);
    }
    beam.maker.json["skins"][0] = {{"joints", joints}};
    beam.bend(0.5);
    EXPECT_EQ(load(beam.maker)->instances.size(), 1u);
    // Many skins of as many joints on little data: refused by the memory that they would take.
    beam.maker.json["skins"][0]["inverseBindMatrices"] =
        beam.maker.append("accessors", {{"componentType", 5126}, {"count", kJoints}, {"type", "MAT4"}});
    for (size_t s = 1; s < 15; ++s) {
        beam.maker.append("skins", beam.maker.json["skins"][0]);
        beam.maker.show(0);
        beam.maker.json["nodes"].back()["skin"] = s;
    }
    const Error error = loadError(beam.maker);
    EXPECT_TRUE(contains(error.problem(), "the geometry would expand")) << error.what();
}

TEST(SkinLimits, ManyPosesOfOneMeshAreBounded) {
    Beam beam(2000);
    for (size_t n = 0; n < 3000; ++n) {
        beam.maker.append("skins", {{"joints", {1, 2}}});
        beam.maker.show(0);
        beam.maker.json["nodes"].back()["skin"] = beam.maker.json["skins"].size() - 1;
    }
    const Error error = loadError(beam.maker);
    EXPECT_TRUE(contains(error.problem(), "the geometry would expand")) << error.what();
}

} // namespace
} // namespace touchstone::skin_limits_test
