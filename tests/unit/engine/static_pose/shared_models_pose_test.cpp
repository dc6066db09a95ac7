// The shared models with skins, morph targets and instances, at rest, against the specification.
#include "engine/scene/animation.h"
#include "tests/support/shared_files.h"
#include "tests/unit/engine/static_pose/pose_support.h"

#include <cstdio>

namespace touchstone::shared_models_pose_test {
namespace {

class SharedPose : public testing::TestWithParam<const char*> {};

TEST_P(SharedPose, IsThatOfTheSpecification) {
    const auto folder = test::modelsFolder();
    if (!folder)
        GTEST_SKIP() << test::kNoModels;
    const auto path = *folder / GetParam();
    const ScenePtr scene = loadScene(path);
    const test::PoseDifference off =
        test::compare(test::evaluatePose(test::readTruthFile(path)), test::objectsOf(*scene));
    EXPECT_EQ(off.problem, "");
    EXPECT_LT(off.position, test::kPoseTolerance) << off.worst;
    EXPECT_LT(off.normal, test::kPoseTolerance) << off.worst;
    std::printf("%-40s position %.2Le of the size, normal %.2Le\n", GetParam(), off.position, off.normal);
    for (const Warning& warning : scene->warnings)
        EXPECT_FALSE(test::contains(warning.message, "rest pose")) << warning.message;
    // What moves begins in the same pose.
    const std::vector<glm::dmat4> poses = sceneFromMeshAt(*scene, nullptr, 0.0);
    for (size_t i = 0; i < poses.size(); ++i)
        EXPECT_EQ(poses[i], scene->instances[i].sceneFromMesh);
}

INSTANTIATE_TEST_SUITE_P(Models, SharedPose,
                         testing::Values("RiggedSimple.glb", "RiggedFigure.glb", "AnimatedMorphCube.glb",
                                         "SimpleInstancing.glb", "gltf/SimpleSkin/SimpleSkin.gltf",
                                         "gltf/SimpleMorph/SimpleMorph.gltf", "Suzanne.glb", "ToyCar.glb"));

} // namespace
} // namespace touchstone::shared_models_pose_test
