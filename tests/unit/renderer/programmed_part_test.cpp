// What of a scene a driver compiles its programs with.

#include "engine/scene/mesh_vertices.h"
#include "renderer/prepared_scene.h"
#include "renderer/programmed_part.h"

#include <gtest/gtest.h>

namespace touchstone::test {
namespace {

MaterialProgram someProgram() {
    MaterialProgram program;
    program.compiled = std::make_shared<SurfaceProgram>();
    return program;
}

Mesh meshOf(int material) {
    Mesh mesh;
    mesh.material = material;
    for (int i = 0; i < 7; ++i) {
        mesh.positions.emplace_back(i, i * i, 0);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.uv0.emplace_back(i, 0);
    }
    mesh.indices = {4, 2, 6, 0, 1, 2};
    return mesh;
}

Image imageOf(int size) {
    Image image;
    image.width = image.height = image.pixels.width = image.pixels.height = size;
    image.channels = image.pixels.channels = 1;
    image.decoded = true;
    image.pixels.bytes.resize(static_cast<size_t>(size) * static_cast<size_t>(size));
    return image;
}

TEST(ProgrammedPart, HasOneTriangleOfEachMeshWithAProgramAndTheImagesOfItsMaterial) {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].haptic.program = someProgram(); // that of before, which is to go
    scene.materials[1].baseColorTexture.image = 1;
    scene.materials[2].normalTexture.image = 0;
    scene.images = {imageOf(4), imageOf(8)};
    for (const int material : {0, 1, 1, 2})
        scene.meshes.push_back(meshOf(material));
    Mesh lines = meshOf(1);
    lines.indices.clear();
    lines.lineIndices = {0, 1};
    scene.meshes.push_back(lines);

    const MaterialProgram program = someProgram();
    const ScenePtr part = programmedPart(scene, {{}, program, {}});
    ASSERT_NE(part, nullptr);
    ASSERT_EQ(part->meshes.size(), 2u);
    for (size_t m = 0; m < 2; ++m) {
        const Mesh& mesh = part->meshes[m];
        EXPECT_EQ(meshFault(mesh), std::nullopt);
        EXPECT_EQ(mesh.material, 1);
        EXPECT_EQ(mesh.triangleCount(), 1u);
        EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{4, 16, 0}, {2, 4, 0}, {6, 36, 0}}));
        EXPECT_EQ(mesh.uv0, (std::vector<glm::vec2>{{4, 0}, {2, 0}, {6, 0}}));
        EXPECT_TRUE(mesh.colors.empty());
        EXPECT_EQ(part->instances[m].mesh, static_cast<int>(m));
    }
    EXPECT_EQ(part->materials[1].haptic.program, program);
    EXPECT_FALSE(part->materials[0].haptic.program);
    EXPECT_TRUE(usableTexture(*part, part->materials[1].baseColorTexture));
    EXPECT_FALSE(usableTexture(*part, part->materials[2].normalTexture)) << "nothing shows it";
    EXPECT_EQ(programmedPart(scene, {{}, {}, program})->meshes.size(), 1u);
    EXPECT_EQ(programmedPart(scene, {{}, {}, {}}), nullptr);
}

} // namespace
} // namespace touchstone::test
