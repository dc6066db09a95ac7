#include "tests/unit/engine/load_support.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace touchstone::gltf_nodes_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;

double difference(const glm::dmat4& a, const glm::dmat4& b) {
    double largest = 0.0;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
    return largest;
}

TEST(GltfNodes, TransformsComposeFromTheRootDown) {
    GltfMaker maker = GltfMaker::square();
    // The child comes before its parent in the file.
    maker.json["nodes"] = {{{"mesh", 0}, {"scale", {2, 3, -4}}},
                           {{"children", {0}},
                            {"translation", {1, 2, 3}},
                            {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}};
    maker.json["scenes"] = {{{"nodes", {1}}}};
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->nodes.size(), 2u);
    for (size_t i = 0; i < scene->nodes.size(); ++i)
        EXPECT_LT(scene->nodes[i].parent, static_cast<int>(i));
    const glm::dmat4 expected = glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3)) *
                                glm::rotate(glm::dmat4(1.0), std::acos(0.0), glm::dvec3(0, 0, 1)) *
                                glm::scale(glm::dmat4(1.0), glm::dvec3(2, 3, -4));
    ASSERT_EQ(scene->instances.size(), 1u);
    EXPECT_LT(difference(scene->instances[0].sceneFromMesh, expected), 1e-12);
    EXPECT_LT(glm::determinant(glm::dmat3(scene->instances[0].sceneFromMesh)), 0.0); // the mirror survives
    EXPECT_NEAR(scene->bounds.low.x, 1.0 - 3.0, 1e-12); // y of the square, times 3, turned to -x
    EXPECT_NEAR(scene->bounds.high.y, 2.0 + 2.0, 1e-12);
}

TEST(GltfNodes, AMatrixIsUsedVerbatim) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}; // shears
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->nodes[0].hasMatrix);
    EXPECT_EQ(scene->instances[0].sceneFromMesh[1], glm::dvec4(0.5, 1, 0, 0));
    EXPECT_EQ(scene->instances[0].sceneFromMesh[3], glm::dvec4(7, 8, 9, 1));
    maker.json["nodes"][0]["matrix"][3] = 0.5;
    EXPECT_REFUSED(maker, "nodes[0].matrix", "not affine");
    maker.json["nodes"][0]["matrix"][3] = 0.0;
    maker.json["nodes"][0]["matrix"][15] = 0.99999994;
    EXPECT_MENDED(maker, "nodes[0].matrix", "up to rounding");
    EXPECT_EQ(load(maker)->instances[0].sceneFromMesh[3].w, 1.0);
}

/// A generated file had a model of 1e-28 m at 0.03 m: fitted, the roundings of its coordinates lay 4e9 m
/// apart and no sample of the hand on its stroke was taken.
TEST(GltfNodes, AFittedModelIsNoLargerThanTheRoundingOfItsPlaceAllows) {
    for (const double size : {1.0, 1e-6, 1e-12, 1e-28})
        for (const double away : {0.0, 0.03, 1e6}) {
            Scene scene;
            scene.bounds.include(glm::dvec3(away, 0.0, 0.0));
            scene.bounds.include(glm::dvec3(away + size, size, 0.0));
            const Similarity fit = workspaceFromScene(scene, Fit::Workspace);
            const double rounding = fit.scale * 1e-16 * away;
            EXPECT_LT(rounding, 2e-8) << size << " m at " << away;
            if (size > 1e-8 * away) {
                EXPECT_NEAR(fit.scale * size, kFittedExtent, 1e-6);
            }
            EXPECT_LT(glm::length(fit.point(glm::dvec3(away, 0.0, 0.0))), kFittedExtent);
        }
}

TEST(GltfNodes, LoopsAndSecondParentsAreRefused) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
    EXPECT_REFUSED(maker, "nodes[1].children", "loop");
    maker.json["nodes"] = {{{"mesh", 0}, {"children", {0}}}};
    maker.json["scenes"] = {{{"name", "empty"}}};
    EXPECT_REFUSED(maker, "nodes[0].children", "loop");
    maker.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    maker.json["scenes"] = {{{"nodes", {0, 1}}}};
    EXPECT_REFUSED(maker, "nodes[1].children[0]", "already has a parent");
}

TEST(GltfNodes, ChainsOfAnyDepthLoad) {
    GltfMaker maker = GltfMaker::square();
    constexpr size_t kDepth = 100'000;
    json nodes = json::array();
    for (size_t i = 0; i + 1 < kDepth; ++i)
        nodes.push_back({{"children", {i + 1}}, {"translation", {0.001, 0, 0}}});
    nodes.push_back({{"mesh", 0}});
    maker.json["nodes"] = nodes;
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->nodes.size(), kDepth);
    EXPECT_NEAR(scene->instances[0].sceneFromMesh[3].x, 0.001 * (kDepth - 1), 1e-6);
}

TEST(GltfNodes, TheDefaultSceneIsShownElseTheFirst) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 0, 0}}},
                           {{"mesh", 0}, {"translation", {2, 0, 0}}}};
    maker.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    EXPECT_EQ(load(maker)->instances.at(0).sceneFromMesh[3].x, 1.0);
    maker.json["scene"] = 1;
    ASSERT_EQ(load(maker)->instances.size(), 1u);
    EXPECT_EQ(load(maker)->instances.at(0).sceneFromMesh[3].x, 2.0);
    maker.json["scene"] = 2;
    EXPECT_REFUSED(maker, "scene", "scenes[2]");
    maker.json.erase("scene");
    maker.json.erase("scenes"); // none at all: everything is shown
    EXPECT_EQ(load(maker)->instances.size(), 2u);
}

TEST(GltfNodes, ASceneMayNameAChildAndANodeTwice) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"] = {{{"children", {1}}, {"translation", {5, 0, 0}}}, {{"mesh", 0}}};
    maker.json["scenes"] = {{{"nodes", {1}}}};
    EXPECT_MENDED(maker, "scenes[0].nodes[0]", "not a root");
    ASSERT_EQ(load(maker)->instances.size(), 1u);
    EXPECT_EQ(load(maker)->instances[0].sceneFromMesh[3].x, 5.0); // its parent still places it
    maker.json["scenes"] = {{{"nodes", {0, 1}}}};
    EXPECT_MENDED(maker, "scenes[0].nodes[1]", "not a root");
    maker.json["scenes"] = {{{"nodes", {0, 0}}}};
    EXPECT_MENDED(maker, "scenes[0].nodes[1]", "twice");
    maker.json["scenes"] = {{{"nodes", {0}}}};
    maker.json["nodes"][0]["children"] = {1, 1};
    EXPECT_MENDED(maker, "nodes[0].children[1]", "twice");
    EXPECT_EQ(load(maker)->instances.size(), 1u);
}

TEST(GltfNodes, WhatIsScaledToNothingIsLeftOut) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"][0]["scale"] = {1, 1, 0};
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->instances.empty());
    EXPECT_TRUE(warns(*scene, "nodes[0]", "scaled to nothing"));
}

TEST(GltfNodes, PlacesBeyondAllNumbersAreRefused) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"] = {{{"children", {1}}, {"scale", {1e300, 1e300, 1e300}}},
                           {{"mesh", 0}, {"scale", {1e300, 1e300, 1e300}}}};
    maker.json["scenes"] = {{{"nodes", {0}}}};
    EXPECT_REFUSED(maker, "nodes[1]", "beyond what numbers can hold");
}

} // namespace
} // namespace touchstone::gltf_nodes_test
