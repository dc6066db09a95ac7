// Two scenes have one hash where they feel the same, and only there.

#include "haptics/recording/scene_identity.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

namespace touchstone::test {
namespace {

/// A triangle with coordinates, a height map and an animation.
Scene richScene() {
    Scene scene;
    scene.path = "rich";
    Mesh mesh;
    mesh.positions = {{0.0f, 0.0f, 0.0f}, {0.1f, 0.0f, 0.0f}, {0.0f, 0.1f, 0.0f}};
    mesh.normals = {{0.0f, 0.0f, 1.0f}, {0.3f, 0.0f, 0.954f}, {0.0f, 0.3f, 0.954f}};
    mesh.uv0 = {{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}};
    mesh.normalsFromFile = true;
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    Image image;
    image.decoded = true;
    image.pixels.width = image.pixels.height = 2;
    image.pixels.channels = 1;
    image.pixels.bytes = {std::byte{0}, std::byte{80}, std::byte{160}, std::byte{255}};
    scene.images.push_back(image);
    Material material;
    HeightMap height;
    height.texture.image = 0;
    height.scale = 1e-3f;
    material.haptic.height.value = height;
    material.haptic.staticFriction.value = 0.5f;
    scene.materials.push_back(material);
    scene.nodes.emplace_back();
    scene.instances.push_back({.node = 0, .mesh = 0});
    for (const glm::vec3& p : mesh.positions)
        scene.bounds.include(glm::dvec3(p));
    AnimationChannel channel;
    channel.node = 0;
    channel.times = {0.0f, 1.0f};
    channel.values = {glm::vec4(0.0f), glm::vec4(0.0f, 0.1f, 0.0f, 0.0f)};
    scene.animations.push_back({"up", 1.0, {channel}});
    return scene;
}

uint64_t hashOf(const Scene& scene, Fit fit = Fit::None) {
    return feltHash(*compileHapticScene(scene, workspaceFromScene(scene, fit)), scene);
}

TEST(FeltHash, ChangesWithEverythingThatIsFelt) {
    const std::vector<std::function<void(Scene&)>> changes{
        [](Scene&) {},
        [](Scene& s) { s.meshes[0].positions[1].x = std::nextafter(0.1f, 1.0f); },
        [](Scene& s) {
            s.meshes[0].normals[1] = {0.0f, 0.0f, 1.0f};
        },
        [](Scene& s) { s.meshes[0].uv0[1].x = 0.9f; },
        [](Scene& s) { std::swap(s.meshes[0].indices[1], s.meshes[0].indices[2]); },
        [](Scene& s) {
            s.meshes[0].friction = {1.0f, 0.5f, 1.0f};
        },
        [](Scene& s) { s.images[0].pixels.bytes[1] = std::byte{81}; },
        [](Scene& s) { s.materials[0].haptic.height.value->scale = 2e-3f; },
        [](Scene& s) { s.materials[0].haptic.height.value->texture.wrapS = Wrap::ClampToEdge; },
        [](Scene& s) { s.materials[0].haptic.staticFriction.value = 0.6f; },
        [](Scene& s) { s.materials[0].haptic.viscousFriction.value = 1.0f; },
        [](Scene& s) { s.materials[0].haptic.stiffness.value = 400.0f; },
        [](Scene& s) { s.materials[0].haptic.sides = SideChoice::Front; },
        [](Scene& s) { s.materials[0].haptic.forceShading = ShadingChoice::Off; },
        [](Scene& s) { s.instances[0].sceneFromMesh[3].x = 1e-6; },
        [](Scene& s) { s.animations[0].duration = 2.0; },
        [](Scene& s) { s.animations[0].channels[0].values[1].y = 0.11f; },
        [](Scene& s) { s.animations[0].channels[0].times[1] = 0.5f; },
        [](Scene& s) { s.animations[0].channels[0].interpolation = Interpolation::Step; },
        [](Scene& s) { s.animations.clear(); },
        [](Scene& s) { s.nodes[0].translation.y = 0.01; },
        [](Scene& s) { s.nodes[0].rotation = glm::dquat(0.0, 1.0, 0.0, 0.0); },
        [](Scene& s) { s.nodes[0].scale.z = 1.01; },
        [](Scene& s) { s.nodes[0].hasMatrix = true; },
        [](Scene& s) { s.nodes[0].matrix[3].x = 0.01; },
        [](Scene& s) { s.nodes.emplace_back(); },
    };
    std::set<uint64_t> hashes;
    for (size_t i = 0; i < changes.size(); ++i) {
        Scene scene = richScene();
        changes[i](scene);
        EXPECT_TRUE(hashes.insert(hashOf(scene)).second) << "change " << i << " is not in the hash";
    }
    EXPECT_TRUE(hashes.insert(hashOf(richScene(), Fit::Workspace)).second) << "the fit is not in the hash";
}

TEST(FeltHash, StaysWhereOnlyTheLookChanges) {
    Scene scene = richScene();
    scene.materials[0].baseColor = {0.1f, 0.2f, 0.3f, 1.0f};
    scene.materials[0].name = scene.meshes[0].name = scene.path = "another";
    scene.materials[0].emissive = {1.0f, 0.0f, 0.0f};
    EXPECT_EQ(hashOf(scene), hashOf(richScene()));
    EXPECT_EQ(hashOf(richScene()), hashOf(richScene()));
}

TEST(SceneIdentity, TellsTheFileByItsBytes) {
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "scene.glb";
    const auto identityWith = [&](const std::string& bytes) {
        writeTextFile(file, bytes);
        Scene scene = richScene();
        scene.path = file.string();
        return identify(*compileHapticScene(scene, Similarity{}), scene, Fit::None);
    };
    const SceneIdentity a = identityWith("one"), b = identityWith("two"), again = identityWith("one");
    EXPECT_EQ(a.fileSize, 3u);
    EXPECT_NE(a.fileHash, b.fileHash);
    EXPECT_EQ(a.fileHash, again.fileHash);
    EXPECT_EQ(a.feltHash, b.feltHash);
    EXPECT_EQ(a.absolutePath, std::filesystem::canonical(file).string());
    std::filesystem::remove(file);
    Scene gone = richScene();
    gone.path = file.string();
    const SceneIdentity none = identify(*compileHapticScene(gone, Similarity{}), gone, Fit::None);
    EXPECT_EQ(none.fileSize, 0u);
    EXPECT_EQ(none.absolutePath, "");
}

} // namespace
} // namespace touchstone::test
