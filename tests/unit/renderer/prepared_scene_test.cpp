#include "renderer/prepared_scene.h"
#include "tests/support/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchstone {
namespace {

std::shared_ptr<Scene> torus(int columns, int rows) {
    auto scene = std::make_shared<Scene>();
    scene->materials.push_back({});
    test::place(*scene, test::torusMesh(0.060, 0.025, columns, rows, {1.0f, 1.0f}), 0);
    return scene;
}

/// How far a place is from the torus about the y axis.
double offTorus(const glm::dvec3& p) {
    const double ring = std::hypot(p.x, p.z) - 0.060;
    return std::abs(std::hypot(ring, p.y) - 0.025);
}

TEST(PreparedScene, EachLevelHasHalfTheTrianglesAndTellsItsErrorHonestly) {
    const auto prepared = prepareScene(torus(324, 100), {.coarsest = 500});
    const PreparedMesh& mesh = prepared->meshes.at(0);
    ASSERT_GE(mesh.levels.size(), 5u);
    EXPECT_EQ(mesh.levels[0].error, 0.0);
    EXPECT_EQ(mesh.levels[0].indexCount, 3u * 64800u);
    const double sag = 0.025 * (1.0 - std::cos(3.1416 / 100.0)); // of the full mesh itself
    for (size_t l = 1; l < mesh.levels.size(); ++l) {
        const DrawLevel& level = mesh.levels[l];
        EXPECT_LT(level.indexCount, 0.6 * mesh.levels[l - 1].indexCount);
        EXPECT_GT(level.error, mesh.levels[l - 1].error);
        EXPECT_LT(level.error, 0.02) << "of a tube 25 mm thick";
        std::vector<double> off; // of places spread over each triangle; a torus' triangles are of like size
        for (uint32_t i = 0; i < level.indexCount; i += 3) {
            const auto corner = [&](uint32_t c) {
                const uint32_t index = prepared->indices.at(level.firstIndex + i + c);
                return glm::dvec3(prepared->vertices.at(index).position) + mesh.centre;
            };
            constexpr double kMuch = 2.0 / 3.0, kLittle = 1.0 / 6.0;
            for (const glm::dvec3& share :
                 {glm::dvec3(kMuch, kLittle, kLittle), glm::dvec3(kLittle, kMuch, kLittle),
                  glm::dvec3(kLittle, kLittle, kMuch)})
                off.push_back(offTorus(share.x * corner(0) + share.y * corner(1) + share.z * corner(2)));
        }
        std::ranges::sort(off);
        const double most = off[off.size() * 99 / 100];
        EXPECT_LT(most, 2.0 * level.error + sag) << "level " << l;
        EXPECT_GT(most, 0.5 * level.error) << "level " << l;
        EXPECT_LT(off.back(), 7.0 * level.error + sag) << "level " << l;
    }
}

TEST(PreparedScene, EachLevelTellsTheMeanOfItsOwnEdges) {
    const auto prepared = prepareScene(torus(324, 100), {.coarsest = 500});
    const PreparedMesh& mesh = prepared->meshes.at(0);
    for (size_t l = 0; l < mesh.levels.size(); ++l) {
        const DrawLevel& level = mesh.levels[l];
        double sum = 0.0;
        for (uint32_t i = 0; i < level.indexCount; ++i) {
            const uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
            const auto at = [&](uint32_t k) {
                return glm::dvec3(prepared->vertices.at(prepared->indices.at(level.firstIndex + k)).position);
            };
            sum += glm::distance(at(i), at(next));
        }
        EXPECT_NEAR(level.meanEdge, sum / level.indexCount, 1e-6 * level.meanEdge) << "level " << l;
        const double finer = l > 0 ? mesh.levels[l - 1].meanEdge : 0.0;
        EXPECT_GT(level.meanEdge, 1.2 * finer) << "half of the triangles";
    }
}

TEST(PreparedScene, SmallMeshesAndUnwantedLevelsStayAsTheyAre) {
    EXPECT_EQ(prepareScene(torus(10, 10))->meshes[0].levels.size(), 1u);
    EXPECT_EQ(prepareScene(torus(324, 100), {.coarsest = 0})->meshes[0].levels.size(), 1u);
    const std::atomic<bool> cancelled{true};
    EXPECT_EQ(prepareScene(torus(324, 100), {.cancel = &cancelled})->meshes[0].levels.size(), 1u);
}

TEST(PreparedScene, ACoarseLevelIsTakenOnlyWithinTheAllowedError) {
    PreparedMesh mesh;
    mesh.levels = {{0, 300, 0.0}, {300, 150, 0.1}, {450, 75, 0.4}};
    EXPECT_EQ(levelWithin(mesh, 0.0).indexCount, 300u);
    EXPECT_EQ(levelWithin(mesh, 0.099).indexCount, 300u);
    EXPECT_EQ(levelWithin(mesh, 0.1).indexCount, 150u);
    EXPECT_EQ(levelWithin(mesh, 1e9).indexCount, 75u);
}

TEST(PreparedScene, TexturesOfTheLookArePreparedAndBrokenOnesAreNot) {
    auto scene = torus(8, 6);
    scene->images.push_back(test::checkerImage("color", 4, glm::vec4(1.0f), glm::vec4(0.0f)));
    scene->images.push_back({});
    scene->materials[0].baseColorTexture = scene->materials[0].metallicRoughnessTexture = test::texture(0);
    scene->materials[0].normalTexture = test::texture(1);
    const auto prepared = prepareScene(scene);
    EXPECT_EQ(prepared->textures.size(), 2u) << "one image in two roles";
    EXPECT_EQ(prepared->textures.count({0, TextureRole::Color}), 1u);
    EXPECT_EQ(prepared->textures.count({0, TextureRole::Data}), 1u);
}

TEST(PreparedScene, LinesAndPointsFollowBehindAllTriangles) {
    auto scene = torus(8, 6);
    Mesh strokes;
    strokes.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}};
    strokes.lineIndices = {0, 1, 1, 2};
    test::place(*scene, strokes, 0);
    test::place(*scene, scene->meshes[0], 0);
    strokes.lineIndices.clear();
    strokes.pointIndices = {2, 0};
    test::place(*scene, strokes, 0);
    const auto prepared = prepareScene(scene);
    const size_t one = scene->meshes[0].positions.size();
    EXPECT_EQ(prepared->meshes[2].firstVertex, static_cast<int32_t>(one)) << "false colours count through";
    EXPECT_EQ(prepared->meshes[1].strokeVertex, 2 * one);
    EXPECT_EQ(prepared->meshes[1].strokes, 2u);
    EXPECT_EQ(prepared->meshes[3].strokeVertex, 2 * one + 4);
    EXPECT_EQ(prepared->meshes[3].strokes, 2u);
    EXPECT_EQ(prepared->vertices.size(), 2 * one + 4 + 2);
    EXPECT_EQ(prepared->vertices[2 * one + 3].position.x, 1.0f) << "2, from the middle of the mesh";
    EXPECT_FALSE(prepared->meshes[1].empty());
}

} // namespace
} // namespace touchstone
