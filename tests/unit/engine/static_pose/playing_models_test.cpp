// The animated shared models at ten times against the specification, and what keeps its deformation.
#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "tests/support/shared_files.h"
#include "tests/unit/engine/static_pose/pose_support.h"

#include <cstdio>

namespace touchstone::playing_models_test {
namespace {

class PlayingModel : public testing::TestWithParam<const char*> {};

TEST_P(PlayingModel, HasTheSpecificationsPositionsAtTenTimes) {
    const auto folder = test::modelsFolder();
    if (!folder)
        GTEST_SKIP() << test::kNoModels;
    const auto path = *folder / GetParam();
    const ScenePtr scene = loadScene(path);
    const test::TruthFile file = test::readTruthFile(path);
    const test::TruthFile still = file;
    ASSERT_FALSE(scene->animations.empty());
    test::Real worst = 0, worstNormal = 0, farthest = 0;
    for (size_t a = 0; a < scene->animations.size(); ++a) {
        const Animation& animation = scene->animations[a];
        for (int k = 0; k < 10; ++k) {
            // Off the keys, the first before and the last behind them.
            const double time = animation.duration * (-0.05 + 1.1 * k / 9.0);
            const auto truth = test::evaluatePose(test::animated(file, a, time));
            const auto shown = test::objectsOf(test::sceneAt(*scene, &animation, time));
            const test::PoseDifference off = test::compare(truth, shown);
            EXPECT_EQ(off.problem, "") << time;
            EXPECT_LT(off.position, test::kPoseTolerance) << off.worst << " at " << time << " s";
            EXPECT_LT(off.normal, test::kPoseTolerance) << off.worst << " at " << time << " s";
            worst = std::max(worst, off.position);
            worstNormal = std::max(worstNormal, off.normal);
            farthest = std::max(farthest, test::compare(test::evaluatePose(still), shown).position);
        }
    }
    EXPECT_GT(farthest, 0.01) << "nothing moves";
    std::printf("%-36s position %.2Le of the size, normal %.2Le; moves by %.2Lf\n", GetParam(), worst,
                worstNormal, farthest);
}

INSTANTIATE_TEST_SUITE_P(Models, PlayingModel,
                         testing::Values("RiggedSimple.glb", "RiggedFigure.glb", "AnimatedMorphCube.glb",
                                         "gltf/SimpleSkin/SimpleSkin.gltf",
                                         "gltf/SimpleMorph/SimpleMorph.gltf"));

/// The beam's upper joint turns by 90 degrees about z in a second.
void turnUpperJoint(test::Beam& beam) {
    const size_t times = test::addTimes(beam.maker);
    const float half = std::sqrt(0.5f);
    const size_t turns = beam.maker.addAccessor<float>({0, 0, 0, 1, 0, 0, half, half}, "VEC4");
    beam.maker.append("animations",
                      {{"name", "bend"},
                       {"samplers", {{{"input", times}, {"output", turns}}}},
                       {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}});
}

TEST(MeshDeformation, IsKeptOnlyWhereAnAnimationDrivesIt) {
    test::Beam still, bending;
    turnUpperJoint(bending);
    const ScenePtr without = test::load(still.maker), with = test::load(bending.maker);
    EXPECT_EQ(without->meshes[0].deformation, nullptr);
    EXPECT_TRUE(without->meshes[0].sources.empty());
    ASSERT_NE(with->meshes[0].deformation, nullptr);
    EXPECT_EQ(with->meshes[0].deformation->joints.size(), 2u);
    EXPECT_EQ(with->meshes[0].positions, without->meshes[0].positions);
    EXPECT_EQ(playedAnimation(*with), &with->animations[0]);
}

TEST(MeshDeformation, BendsTheBeamAsTheSpecificationSays) {
    test::Beam beam;
    turnUpperJoint(beam);
    const ScenePtr scene = test::load(beam.maker);
    for (const double time : {0.0, 0.25, 0.5, 0.9, 1.0}) {
        const auto truth = test::evaluatePose(test::animated(test::truthFile(beam.maker), 0, time));
        const auto off =
            test::compare(truth, test::objectsOf(test::sceneAt(*scene, &scene->animations[0], time)));
        EXPECT_EQ(off.problem, "");
        EXPECT_LT(off.position, 1e-6L) << time;
        EXPECT_LT(off.normal, 1e-6L) << time;
    }
}

/// A triangle with one target that lifts it by 1 m; two nodes show it, of which node 0 is animated.
test::GltfMaker liftedTriangle(const nlohmann::json& sampler, size_t& times) {
    test::GltfMaker maker;
    const size_t positions = maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    maker.json["accessors"][positions]["min"] = {0.0, 0.0, 0.0};
    maker.json["accessors"][positions]["max"] = {1.0, 1.0, 0.0};
    const size_t lift = maker.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    maker.json["accessors"][lift]["min"] = {0.0, 0.0, 1.0};
    maker.json["accessors"][lift]["max"] = {0.0, 0.0, 1.0};
    maker.append(
        "meshes",
        {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", lift}}}}}}},
         {"weights", {0.25}}});
    maker.show(0);
    maker.append("nodes", {{"mesh", 0}});
    maker.json["scenes"][0]["nodes"].push_back(1);
    times = test::addTimes(maker);
    maker.append("animations",
                 {{"samplers", {sampler}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    maker.json["animations"][0]["samplers"][0]["input"] = times;
    return maker;
}

TEST(MeshDeformation, AnotherNodesWeightsStay) {
    size_t times = 0;
    test::GltfMaker maker = liftedTriangle({{"output", 0}}, times);
    maker.json["animations"][0]["samplers"][0]["output"] = maker.addAccessor<float>({0.0f, 1.0f}, "SCALAR");
    const ScenePtr scene = test::load(maker);
    ASSERT_EQ(scene->instances.size(), 2u);
    const Scene shown = test::sceneAt(*scene, &scene->animations[0], 0.5);
    for (const Instance& instance : shown.instances) {
        const float z = shown.meshes[static_cast<size_t>(instance.mesh)].positions[0].z;
        EXPECT_FLOAT_EQ(z, instance.node == 0 ? 0.5f : 0.25f);
    }
}

TEST(MeshDeformation, WeightsFollowACubicSpline) {
    size_t times = 0;
    test::GltfMaker maker = liftedTriangle({{"output", 0}, {"interpolation", "CUBICSPLINE"}}, times);
    maker.json["animations"][0]["samplers"][0]["output"] =
        maker.addAccessor<float>({0, 0.1f, 2.0f, -1.0f, 0.7f, 0}, "SCALAR");
    const ScenePtr scene = test::load(maker);
    for (const double time : {0.0, 0.3, 0.8}) {
        const auto truth = test::evaluatePose(test::animated(test::truthFile(maker), 0, time));
        const auto off =
            test::compare(truth, test::objectsOf(test::sceneAt(*scene, &scene->animations[0], time)));
        EXPECT_LT(off.position, 1e-6L) << time;
    }
}

TEST(MeshDeformation, BrokenWeightsLeaveTheStaticPose) {
    const auto broken = [](const auto& spoil, const char* message) {
        size_t times = 0;
        test::GltfMaker maker = liftedTriangle({{"output", 0}}, times);
        maker.json["animations"][0]["samplers"][0]["output"] =
            maker.addAccessor<float>({0.0f, 1.0f}, "SCALAR");
        spoil(maker);
        const ScenePtr scene = test::load(maker);
        EXPECT_EQ(scene->meshes[0].deformation, nullptr) << message;
        EXPECT_TRUE(test::warns(*scene, "animations[0]", message)) << message;
    };
    broken(
        [](test::GltfMaker& m) {
            m.json["animations"][0]["samplers"][0]["output"] =
                m.addAccessor<float>({0.0f, 1.0f, 2.0f}, "SCALAR");
        },
        "values where");
    broken(
        [](test::GltfMaker& m) {
            m.json["animations"][0]["samplers"][0]["output"] =
                m.addAccessor<float>({0.0f, INFINITY}, "SCALAR");
        },
        "not finite");
    broken(
        [](test::GltfMaker& m) {
            m.json["meshes"][0]["primitives"][0].erase("targets");
            m.json["meshes"][0].erase("weights");
        },
        "without morph targets");
}

TEST(MeshDeformation, AnAnimationIsChosenByNameOrNumber) {
    test::Beam beam;
    turnUpperJoint(beam);
    turnUpperJoint(beam);
    beam.maker.json["animations"][1]["name"] = "again";
    LoadOptions options;
    EXPECT_EQ(test::load(beam.maker)->animation, -1);
    options.animation = "again";
    EXPECT_EQ(test::load(beam.maker, options)->animation, 1);
    options.animation = "0";
    const ScenePtr first = test::load(beam.maker, options);
    EXPECT_EQ(playedAnimation(*first), &first->animations[0]);
    options.animation = "walk";
    EXPECT_THROW((void)test::load(beam.maker, options), Error);
}

} // namespace
} // namespace touchstone::playing_models_test
