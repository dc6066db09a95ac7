// Real models, where the environment has them.
#include "tests/support/shared_files.h"
#include "tests/unit/engine/load_support.h"

#include <cmath>
#include <map>

namespace touchstone::shared_models_test {
namespace {

void expectSound(const Scene& scene) {
    EXPECT_TRUE(scene.touchable());
    EXPECT_FALSE(scene.bounds.empty());
    EXPECT_FALSE(scene.materials.empty());
    for (const Instance& instance : scene.instances) {
        ASSERT_LT(static_cast<size_t>(instance.mesh), scene.meshes.size());
        ASSERT_LT(static_cast<size_t>(instance.node), scene.nodes.size());
    }
    for (size_t n = 0; n < scene.nodes.size(); ++n)
        EXPECT_LT(scene.nodes[n].parent, static_cast<int>(n));
    for (const Image& image : scene.images)
        EXPECT_EQ(image.problem, "") << image.name;
    for (const Mesh& mesh : scene.meshes) {
        const size_t count = mesh.positions.size();
        const bool drawnOnly = mesh.lineCount() > 0 || mesh.pointCount() > 0;
        ASSERT_TRUE(mesh.normals.size() == count || (drawnOnly && mesh.normals.empty()));
        ASSERT_LT(static_cast<size_t>(mesh.material), scene.materials.size());
        EXPECT_TRUE(mesh.tangents.empty() || mesh.tangents.size() == count);
        EXPECT_TRUE(mesh.uv0.empty() || mesh.uv0.size() == count);
        EXPECT_EQ(mesh.indices.size() % 3, 0u);
        for (const uint32_t index : mesh.indices)
            ASSERT_LT(index, count);
        for (const glm::vec3& normal : mesh.normals)
            ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f);
        // Whoever has a normal map has a frame to read it in.
        EXPECT_EQ(mesh.tangents.empty(),
                  !scene.materials[static_cast<size_t>(mesh.material)].normalTexture &&
                      !scene.materials[static_cast<size_t>(mesh.material)].haptic.height.value);
    }
}

struct Expected {
    uint64_t triangles;
    size_t instances;
};
/// What the models that the tests were written with hold. Others are held to what any model must hold.
const std::map<std::string, Expected> kExpected = {
    {"Barrel.glb", {1148, 1}},
    {"Box.glb", {12, 1}},
    {"BoxInterleaved.glb", {12, 1}},
    {"ClearcoatWicker.glb", {3072, 1}},
    {"NormalTangentTest.glb", {7774, 1}},
    {"RiggedSimple.glb", {188, 1}},
    {"Suzanne.glb", {3936, 1}},
    {"ToyCar.glb", {108936, 3}},
    {"WaterBottle.glb", {4510, 1}},
    {"gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf", {12, 1}},
    {"gltf/TextureTransformTest/TextureTransformTest.gltf", {24, 12}},
};

TEST(SharedModels, EveryOneLoadsSound) {
    const auto models = test::modelsFolder();
    if (!models)
        GTEST_SKIP() << test::kNoModels;
    size_t known = 0;
    for (const auto& file : test::gltfFilesIn(*models)) {
        const std::string name = std::filesystem::relative(file, *models).generic_string();
        SCOPED_TRACE(name);
        const ScenePtr scene = loadScene(file);
        expectSound(*scene);
        const auto expected = kExpected.find(name);
        if (expected == kExpected.end())
            continue;
        ++known;
        EXPECT_EQ(scene->triangleCount(), expected->second.triangles);
        EXPECT_EQ(scene->instances.size(), expected->second.instances);
    }
    EXPECT_EQ(known, kExpected.size()) << "one of the models above is missing";
}

TEST(OurScenes, LoadSoundWithoutAWarning) {
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TOUCHSTONE_ASSETS)) {
        if (entry.path().extension() != ".glb")
            continue;
        ++files;
        const ScenePtr scene = loadScene(entry.path());
        expectSound(*scene);
        for (const Warning& warning : scene->warnings)
            if (!test::contains(warning.message, "drawn, but cannot be touched")) // lines of materials.glb
                ADD_FAILURE() << entry.path() << ": " << warning.place << ": " << warning.message;
    }
    EXPECT_GT(files, 0u);
}

} // namespace
} // namespace touchstone::shared_models_test
