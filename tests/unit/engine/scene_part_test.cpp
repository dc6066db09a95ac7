// Parts of a scene: names, hidden nodes, and meshes that a plane cuts.

#include "engine/core/error.h"
#include "engine/scene/clip_mesh.h"
#include "engine/scene/scene_part.h"
#include "engine/volume/volume.h"
#include "tests/support/test_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

namespace touchstone::test::scene_part_test {
namespace {

/// A torus and a sphere beneath a group, and a second sphere beside it; the third mesh's node has no name.
Scene threeObjects() {
    Scene scene;
    scene.materials.emplace_back();
    scene.nodes.push_back({.name = "group"});
    place(scene, torusMesh(0.05, 0.02, 24, 12), 0);
    place(scene, sphereMesh(0.03, 16, 8), 0);
    place(scene, sphereMesh(0.01, 16, 8), 0);
    scene.nodes[1].name = "ring";
    scene.nodes[2].name = "ball";
    scene.nodes[1].parent = scene.nodes[2].parent = 0;
    scene.meshes[2].name = "bead";
    return scene;
}

TEST(ScenePart, HidesANodeWithAllBelowItAndShowsItAgain) {
    const Scene scene = threeObjects();
    ScenePart part;
    EXPECT_TRUE(part.whole());
    hideNode(scene, 0, part);
    EXPECT_EQ(part.hidden, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(hiddenInstances(scene, part), (std::vector<bool>{true, true, false}));
    showNode(scene, 1, part);
    EXPECT_EQ(part.hidden, (std::vector<int>{0, 2}));
    EXPECT_EQ(hiddenInstances(scene, part), (std::vector<bool>{false, true, false}));
    const int bead = 3;
    isolateNodes(scene, std::span(&bead, 1), part);
    EXPECT_EQ(part.hidden, (std::vector<int>{0, 1, 2}));
}

TEST(ScenePart, KnowsNodesByTheirLabelAndByTheirMesh) {
    const Scene scene = threeObjects();
    EXPECT_EQ(nodesNamed(scene, "ring"), std::vector<int>{1});
    EXPECT_EQ(nodesNamed(scene, "node 3"), std::vector<int>{3});
    EXPECT_EQ(nodesNamed(scene, "bead"), std::vector<int>{3});
    EXPECT_TRUE(nodesNamed(scene, "").empty());
    EXPECT_TRUE(nodesNamed(scene, "cube").empty());
    const ScenePart part = partNamed(scene, {.hide = {"ball"}, .isolate = {"group"}, .clip = {}});
    EXPECT_EQ(part.hidden, (std::vector<int>{2, 3}));
    try {
        (void)partNamed(scene, {.hide = {"cube"}, .isolate = {}, .clip = {}});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("'cube'"), std::string::npos);
        EXPECT_NE(error.remedy().find("group, ring, ball, node 3"), std::string::npos);
    }
}

TEST(ScenePart, RefusesPlanesWithoutADirection) {
    const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(clipPlane({0, 0, 0}, 0.1));
    EXPECT_FALSE(clipPlane({nan, 1, 0}, 0.1));
    EXPECT_FALSE(clipPlane({infinite, 1, 0}, 0.1));
    EXPECT_FALSE(clipPlane({0, 1, 0}, nan));
    EXPECT_FALSE(clipPlane({0, 1, 0}, infinite));
    for (const double size : {1e-300, 1.0, 1e300}) {
        const auto plane = clipPlane(size * glm::dvec3(3, 0, -4), 0.1);
        ASSERT_TRUE(plane) << size;
        EXPECT_LT(glm::distance(plane->normal, glm::dvec3(0.6, 0.0, -0.8)), 1e-15);
    }
}

double areaOf(const Mesh& mesh) {
    double area = 0.0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
            c(mesh.positions[mesh.indices[i + 2]]);
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

/// Edges with a triangle on one side only, by their ends' places: seams are closed.
size_t openEdgesOff(const Mesh& mesh, const glm::dvec4& plane, double tolerance) {
    using Place = std::tuple<long long, long long, long long>;
    constexpr double kGrid = 1e5; // seams of the sphere meet up to rounding only
    const auto place = [&](uint32_t v) {
        const glm::dvec3 p(mesh.positions[v]);
        return Place{std::llround(kGrid * p.x), std::llround(kGrid * p.y), std::llround(kGrid * p.z)};
    };
    std::map<std::pair<Place, Place>, int> sides;
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const Place a = place(mesh.indices[i + k]), b = place(mesh.indices[i + (k + 1) % 3]);
            if (a != b)
                sides[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    size_t open = 0;
    for (const auto& [edge, balance] : sides) {
        const auto off = [&](const Place& p) {
            const auto [x, y, z] = p;
            const glm::dvec3 at =
                glm::dvec3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) / kGrid;
            return std::abs(glm::dot(plane, glm::dvec4(at, 1.0))) > tolerance;
        };
        open += balance != 0 && (off(edge.first) || off(edge.second)) ? 1 : 0;
    }
    return open;
}

/// The zone of a sphere below a plane at height h has the area 2 pi r (r + h); both halves together have the
/// area of the whole, whatever the plane.
TEST(ClippedMesh, HasTheAreaOfTheZoneAndIsOpenAtThePlaneOnly) {
    const Mesh whole = sphereMesh(1.0, 128, 64);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int trial = 0; trial < 60; ++trial) {
        // The first ones pass through vertices and along edges.
        const glm::dvec3 normal =
            trial < 6 ? glm::dvec3(trial % 3 == 0, trial % 3 == 1, trial % 3 == 2) * (trial < 3 ? 1.0 : -1.0)
                      : glm::normalize(glm::dvec3(number(random), number(random), number(random)));
        const double offset = trial < 6 ? 0.0 : number(random);
        const glm::dvec4 plane(normal, -offset);
        const Mesh below = clippedMesh(whole, plane, 1e-6).value(),
                   above = clippedMesh(whole, -plane, 1e-6).value();
        EXPECT_NEAR(areaOf(below), 2.0 * glm::pi<double>() * (1.0 + offset), 0.02) << trial;
        // Triangles in the plane belong to both sides; no face of this sphere lies in one.
        EXPECT_NEAR(areaOf(below) + areaOf(above), areaOf(whole), 2e-5) << trial;
        EXPECT_EQ(openEdgesOff(below, plane, 2e-5), 0u) << trial;
        for (const glm::vec3& p : below.positions)
            ASSERT_LE(glm::dot(plane, glm::dvec4(glm::dvec3(p), 1.0)), 2e-6) << trial;
        ASSERT_EQ(below.normals.size(), below.positions.size());
        for (size_t v = 0; v < below.positions.size(); ++v)
            ASSERT_GT(glm::dot(below.normals[v], below.positions[v]), 0.999f) << trial;
    }
}

TEST(ClippedMesh, InterpolatesWhatItsVerticesHave) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.tangents = {{1, 0, 0, -1}, {0, 1, 0, -1}, {1, 0, 0, -1}};
    mesh.uv0 = {{0, 0}, {1, 0}, {0, 1}};
    mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}};
    mesh.stiffness = {100, 500, 100};
    mesh.heights = {0.0f, -0.004f, 0.0f};
    mesh.indices = {0, 1, 2};
    const Mesh cut = clippedMesh(mesh, {1, 0, 0, -1}, 1e-9).value(); // x <= 1
    ASSERT_EQ(cut.indices.size(), 6u);
    EXPECT_NEAR(areaOf(cut), 8.0 - 4.5, 1e-6);
    size_t made = 0;
    for (size_t v = 0; v < cut.positions.size(); ++v)
        if (cut.positions[v].x == 1.0f) {
            ++made;
            EXPECT_FLOAT_EQ(cut.uv0[v].x, 0.25f);
            EXPECT_FLOAT_EQ(cut.stiffness[v], 200.0f);
            EXPECT_FLOAT_EQ(cut.heights[v], -0.001f);
            EXPECT_FLOAT_EQ(cut.colors[v].x, 0.25f);
            EXPECT_NEAR(glm::length(glm::vec3(cut.tangents[v])), 1.0f, 1e-6f);
            EXPECT_EQ(cut.tangents[v].w, -1.0f);
        }
    EXPECT_EQ(made, 2u);
    EXPECT_TRUE(clippedMesh(mesh, {1, 0, 0, 1}, 1e-9).value().indices.empty());
    EXPECT_FALSE(clippedMesh(mesh, {1, 0, 0, -9}, 1e-9));
    EXPECT_FALSE(clippedMesh(mesh, {0, 0, 1, 0}, 1e-9)) << "in the plane";
}

/// A strip of four triangles over 2 x 1.
Mesh strip() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    mesh.indices = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5};
    return mesh;
}

/// The cut leaves this strip as many vertices and triangles as it had.
TEST(ClippedMesh, KnowsThatItCutWhateverIsLeft) {
    const ClipPlane plane = clipPlane({1, 0.5, 0}, 1.0733).value();
    const Mesh cut = clippedMesh(strip(), planeInMesh(plane, glm::dmat4(1.0)), 1e-9).value();
    EXPECT_EQ(cut.positions.size(), 6u);
    EXPECT_EQ(cut.indices.size(), 12u);
    EXPECT_LT(areaOf(cut), 1.5);
}

TEST(ScenePart, LaysStrokesOnWhatIsLeft) {
    const auto scene = std::make_shared<Scene>(threeObjects());
    EXPECT_EQ(sceneOf(scene, {}), scene);
    ScenePart part;
    hideNode(*scene, 1, part);
    part.clip = ClipPlane{{0, 1, 0}, 0.0};
    const ScenePtr left = sceneOf(scene, part);
    ASSERT_EQ(left->instances.size(), 2u);
    EXPECT_EQ(left->triangleCount(), 2u * (16 * 4 * 2));
    EXPECT_EQ(left->bounds.high, scene->bounds.high);
    part.clip = ClipPlane{{0, 1, 0}, -1.0};
    EXPECT_FALSE(sceneOf(scene, part)->touchable());
}

/// Failed: a volume was cut for the eye, and felt whole.
TEST(ScenePart, WhatIsFeltAsAFieldIsFilled) {
    Scene scene = threeObjects();
    EXPECT_FALSE(isFilled(scene, scene.instances[0]));
    scene.materials[0].haptic.implicit = true;
    EXPECT_TRUE(isFilled(scene, scene.instances[0]));
    scene.materials[0].haptic.implicit = false;
    const auto values =
        std::make_shared<const std::vector<uint8_t>>(std::vector<uint8_t>{0, 9, 0, 9, 0, 9, 0, 9});
    VolumeFacts facts;
    facts.size = glm::ivec3(2);
    scene.volume = std::make_shared<const Volume>(facts, *values, values, "volume");
    EXPECT_TRUE(isFilled(scene, scene.instances[0]));
    const auto whole = std::make_shared<const Scene>(scene);
    ScenePart part;
    part.clip = ClipPlane{{0, 1, 0}, 0.0};
    scene.volume = nullptr;
    const auto open = std::make_shared<const Scene>(scene);
    EXPECT_EQ(sceneOf(whole, part)->triangleCount(), sceneOf(open, part)->triangleCount())
        << "its surface is cut like that of a mesh";
}

} // namespace
} // namespace touchstone::test::scene_part_test
