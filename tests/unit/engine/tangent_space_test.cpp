#include "engine/scene/tangent_space.h"
#include "tests/support/shared_files.h"
#include "tests/unit/engine/load_support.h"

#include <atomic>
#include <cmath>
#include <random>

namespace touchstone::tangent_space_test {
namespace {

Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}; // v points down: the image stands upright
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

void expectFrames(const Mesh& mesh) {
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (size_t v = 0; v < mesh.tangents.size(); ++v) {
        EXPECT_NEAR(glm::length(glm::vec3(mesh.tangents[v])), 1.0f, 1e-5f);
        EXPECT_NEAR(glm::dot(glm::vec3(mesh.tangents[v]), mesh.normals[v]), 0.0f, 1e-5f);
        EXPECT_EQ(std::abs(mesh.tangents[v].w), 1.0f);
    }
}

TEST(TangentSpace, AnUprightImageHasItsAxesRightAndUp) {
    Mesh mesh = square();
    generateTangents(mesh, 0);
    expectFrames(mesh);
    ASSERT_EQ(mesh.positions.size(), 4u);
    for (const glm::vec4& tangent : mesh.tangents) {
        EXPECT_NEAR(glm::distance(tangent, glm::vec4(1, 0, 0, 1)), 0.0f, 1e-6f);
        // The bitangent points to the top of the image, where green points too.
        EXPECT_NEAR(
            glm::distance(tangent.w * glm::cross(glm::vec3(0, 0, 1), glm::vec3(tangent)), glm::vec3(0, 1, 0)),
            0.0f, 1e-6f);
    }
}

TEST(TangentSpace, TheSecondUvSetCountsWhenAsked) {
    Mesh mesh = square();
    mesh.uv1 = {{0, 0}, {0, 1}, {1, 1}, {1, 0}}; // u runs along +y
    generateTangents(mesh, 1);
    for (const glm::vec4& tangent : mesh.tangents)
        EXPECT_NEAR(glm::distance(glm::vec3(tangent), glm::vec3(0, 1, 0)), 0.0f, 1e-6f);
}

TEST(TangentSpace, MirroredHalvesAreSplitAtTheirSeam) {
    Mesh mesh; // two squares side by side; the texture runs outwards from the seam on both
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.normals.assign(6, {0, 0, 1});
    mesh.uv0 = {{1, 1}, {0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}};
    mesh.colors.resize(6);
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    generateTangents(mesh, 0);
    expectFrames(mesh);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.colors.size(), 8u); // every array grows alike
    EXPECT_EQ(mesh.uv0.size(), 8u);
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        const bool left = i < 6;
        const glm::vec4 tangent = mesh.tangents[mesh.indices[i]];
        EXPECT_NEAR(glm::distance(tangent, left ? glm::vec4(-1, 0, 0, -1) : glm::vec4(1, 0, 0, 1)), 0.0f,
                    1e-6f)
            << i;
    }
}

TEST(TangentSpace, TrianglesWithoutUvAreaTakeTheirNeighboursFrame) {
    Mesh mesh = square();
    mesh.positions.push_back({0.5f, 2, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.uv0.push_back({0.5f, 0}); // on the line of the two corners it hangs on
    mesh.indices.insert(mesh.indices.end(), {3, 2, 4});
    generateTangents(mesh, 0);
    expectFrames(mesh);
    for (size_t v = 0; v < 4; ++v)
        EXPECT_NEAR(glm::distance(glm::vec3(mesh.tangents[v]), glm::vec3(1, 0, 0)), 0.0f, 1e-6f);
}

TEST(TangentSpace, WithoutAnyUvAreaEveryFrameIsStillAFrame) {
    Mesh mesh = square();
    mesh.uv0.assign(4, {0.5f, 0.5f});
    generateTangents(mesh, 0);
    expectFrames(mesh);
    EXPECT_EQ(mesh.indices.size(), 6u);
}

TEST(TangentSpace, RandomSoupsKeepTheirSurface) {
    std::mt19937 generator(7);
    const auto random = [&] { return static_cast<uint32_t>(generator()); };
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    for (int round = 0; round < 50; ++round) {
        Mesh mesh;
        const uint32_t vertices = 3 + random() % 30;
        for (uint32_t v = 0; v < vertices; ++v) {
            mesh.positions.push_back({number(generator), number(generator), number(generator)});
            mesh.normals.push_back(
                glm::normalize(glm::vec3(number(generator), number(generator), number(generator) + 1.5f)));
            mesh.uv0.push_back(random() % 4 == 0 ? glm::vec2(0.0f)
                                                 : glm::vec2(number(generator), number(generator)));
        }
        for (uint32_t i = 0; i < 3 * (random() % 60); ++i)
            mesh.indices.push_back(random() % vertices);
        const Mesh before = mesh;
        generateTangents(mesh, 0);
        expectFrames(mesh);
        ASSERT_EQ(mesh.indices.size(), before.indices.size());
        for (size_t i = 0; i < mesh.indices.size(); ++i) {
            EXPECT_EQ(mesh.positions[mesh.indices[i]], before.positions[before.indices[i]]);
            EXPECT_EQ(mesh.uv0[mesh.indices[i]], before.uv0[before.indices[i]]);
        }
    }
}

TEST(TangentSpace, ItDoesNotMatterHowTheFileIndexesItsVertices) {
    Mesh shared = square();
    Mesh apart;
    for (const uint32_t index : shared.indices) {
        apart.positions.push_back(shared.positions[index]);
        apart.normals.push_back(shared.normals[index]);
        apart.uv0.push_back(shared.uv0[index] * glm::vec2(1.0f, 0.3f));
        apart.indices.push_back(static_cast<uint32_t>(apart.indices.size()));
    }
    for (glm::vec2& uv : shared.uv0)
        uv *= glm::vec2(1.0f, 0.3f);
    generateTangents(shared, 0);
    generateTangents(apart, 0);
    for (size_t i = 0; i < shared.indices.size(); ++i)
        EXPECT_EQ(shared.tangents[shared.indices[i]], apart.tangents[apart.indices[i]]);
}

/// Triangles around one vertex, an even number, over which the image turns over at every edge: the centre
/// belongs to as many frames as there are.
Mesh turningFan(uint32_t triangles) {
    Mesh mesh;
    mesh.positions.push_back({0, 0, 0});
    mesh.uv0.push_back({0, 0});
    for (uint32_t i = 0; i < triangles; ++i) {
        const double angle = 2.0 * std::acos(-1.0) * i / triangles;
        mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        mesh.uv0.push_back(i % 2 == 0 ? glm::vec2(1, 0) : glm::vec2(0, 1));
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % triangles});
    }
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    return mesh;
}

/// From copy to copy of the centre, as it once was, 1.8e11 steps.
TEST(TangentSpace, AVertexOfManyFramesIsSplitInLittleMoreThanTheirNumber) {
    constexpr uint32_t kTriangles = 600'000;
    Mesh mesh = turningFan(kTriangles);
    const Mesh before = mesh;
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.positions.size(), 3u * kTriangles); // one each for the centre, two for the rim
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        ASSERT_EQ(mesh.positions[mesh.indices[i]], before.positions[before.indices[i]]);
        ASSERT_EQ(mesh.tangents[mesh.indices[i]].w, i / 3 % 2 == 0 ? -1.0f : 1.0f) << i;
    }
}

TEST(TangentSpace, ManyTrianglesAnswerCancel) {
    Mesh mesh = turningFan(100'000);
    const std::atomic<bool> cancel = true;
    EXPECT_THROW(generateTangents(mesh, 0, Progress(nullptr, &cancel)), Cancelled);
    EXPECT_TRUE(mesh.tangents.empty()) << "long before the end";
}

/// Real models carry tangents that their makers' tools computed by the same rules.
class ModelTangents : public testing::TestWithParam<const char*> {};

TEST_P(ModelTangents, AgreeWithThoseOfTheFile) {
    const auto models = test::modelsFolder();
    if (!models)
        GTEST_SKIP() << test::kNoModels;
    LoadOptions options;
    options.images = {false, false};
    const ScenePtr scene = loadScene(*models / GetParam(), options);
    const Mesh& stated = scene->meshes.at(0);
    ASSERT_TRUE(stated.tangentsFromFile);
    Mesh made = stated;
    generateTangents(made, 0);
    expectFrames(made);
    size_t corners = 0, close = 0, sameSign = 0;
    for (size_t i = 0; i < stated.indices.size(); ++i) {
        const glm::vec4 a = stated.tangents[stated.indices[i]], b = made.tangents[made.indices[i]];
        ++corners;
        close += glm::dot(glm::vec3(a), glm::vec3(b)) > std::cos(glm::radians(2.0f)) ? 1 : 0;
        sameSign += a.w == b.w ? 1 : 0;
    }
    RecordProperty("share_within_2_degrees",
                   std::to_string(static_cast<double>(close) / static_cast<double>(corners)));
    EXPECT_GT(static_cast<double>(close), 0.98 * static_cast<double>(corners)) << close << " of " << corners;
    EXPECT_GT(static_cast<double>(sameSign), 0.99 * static_cast<double>(corners))
        << sameSign << " of " << corners;
}

INSTANTIATE_TEST_SUITE_P(Shared, ModelTangents, testing::Values("Barrel.glb", "WaterBottle.glb"));

} // namespace
} // namespace touchstone::tangent_space_test
