#include "renderer/false_color.h"
#include "tests/support/test_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

Scene plate(const Material& material) {
    Scene scene;
    scene.materials.push_back(material);
    test::place(scene, test::quadMesh(0.1), 0);
    return scene;
}

TEST(FalseColorScale, SpansWhatTheMapsCanGive) {
    Material material;
    material.haptic.staticFriction.value = 0.5f;
    material.haptic.friction.value = FactorMap{test::texture(0), 0.2f, 1.6f};
    material.haptic.height.value = HeightMap{test::texture(0), 0.004f, 0.25f};
    const Scene scene = plate(material);
    const FalseColorScale friction = falseColorScale(scene, ViewMode::Friction);
    EXPECT_TRUE(friction.meaningful);
    EXPECT_NEAR(friction.low, 0.1, 1e-7);
    EXPECT_NEAR(friction.high, 0.8, 1e-7);
    const FalseColorScale height = falseColorScale(scene, ViewMode::Height);
    EXPECT_NEAR(height.low, -0.001, 1e-9);
    EXPECT_NEAR(height.high, 0.003, 1e-9);
    EXPECT_EQ(height.unit, "m");
    EXPECT_FALSE(falseColorScale(scene, ViewMode::Stiffness).meaningful);
}

TEST(FalseColorScale, VerticesOutrankTheMaterial) {
    Material material;
    material.haptic.stiffness.value = 10000.0f;
    Scene scene = plate(material);
    scene.meshes[0].stiffness = {100.0f, 200.0f, 300.0f, 400.0f};
    const FalseColorScale scale = falseColorScale(scene, ViewMode::Stiffness);
    EXPECT_EQ(scale.low, 100.0);
    EXPECT_EQ(scale.high, 400.0);
    EXPECT_EQ(scale.unit, "N/m");
}

/// As they are felt: a height map comes before the heights of vertices.
TEST(FalseColorScale, SpansTheHeightsOfVertices) {
    Scene scene;
    scene.materials.resize(2);
    scene.meshes.resize(1);
    scene.meshes[0].positions.resize(3);
    scene.meshes[0].heights = {-0.002f, 0.001f, 0.0f};
    FalseColorScale scale = falseColorScale(scene, ViewMode::Height);
    EXPECT_TRUE(scale.meaningful);
    EXPECT_EQ(scale.unit, "m");
    EXPECT_FLOAT_EQ(static_cast<float>(scale.low), -0.002f);
    EXPECT_FLOAT_EQ(static_cast<float>(scale.high), 0.001f);
    TextureRef map;
    map.image = 0;
    scene.materials[0].haptic.height.value = HeightMap{map, 0.004f, 0.5f};
    scale = falseColorScale(scene, ViewMode::Height);
    EXPECT_FLOAT_EQ(static_cast<float>(scale.high), 0.002f);
}

TEST(FalseColorScale, OneValueStillHasTwoEnds) {
    Material material;
    material.haptic.staticFriction.value = 0.4f;
    const FalseColorScale one = falseColorScale(plate(material), ViewMode::Friction);
    EXPECT_EQ(one.low, 0.0);
    EXPECT_NEAR(one.high, 0.4, 1e-7);
    material.haptic.staticFriction.value = 0.0f;
    const FalseColorScale zero = falseColorScale(plate(material), ViewMode::Friction);
    EXPECT_LT(zero.low, zero.high);
}

TEST(FalseColor, LightnessRisesAndValuesStayInRange) {
    double before = -1.0;
    for (int i = 0; i <= 100; ++i) {
        const glm::vec3 c = falseColor(i / 100.0);
        const double luma = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        EXPECT_GT(luma, before);
        before = luma;
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(c[k], 0.0f);
            EXPECT_LE(c[k], 1.0f);
        }
    }
    EXPECT_EQ(falseColor(-5.0), falseColor(0.0));
    EXPECT_EQ(falseColor(7.0), falseColor(1.0));
}

TEST(DihedralAngles, AreTheAnglesBetweenFacets) {
    Mesh flat = test::quadMesh(0.1, 4);
    for (const float angle : dihedralAngles(flat))
        EXPECT_NEAR(angle, 0.0f, 1e-4f);
    // A roof: two triangles on the z axis, each 35 degrees from level; vertices of their own.
    const auto c = static_cast<float>(std::cos(glm::radians(35.0))),
               d = static_cast<float>(std::sin(glm::radians(35.0)));
    Mesh roof;
    roof.positions = {{0, 0, 0}, {0, 0, 1}, {c, -d, 0}, {0, 0, 1}, {0, 0, 0}, {-c, -d, 0}};
    roof.indices = {0, 1, 2, 3, 4, 5};
    const std::vector<float> angles = dihedralAngles(roof);
    for (const size_t ridge : {0u, 1u, 3u, 4u})
        EXPECT_NEAR(angles[ridge], 70.0f, 1e-3f);
    EXPECT_EQ(angles[2], 0.0f) << "all its edges are borders";
    EXPECT_EQ(angles[5], 0.0f);
}

TEST(DihedralAngles, GrowWithTheCoarsenessOfASphere) {
    const auto most = [](int columns, int rows) {
        const std::vector<float> angles = dihedralAngles(test::sphereMesh(1.0, columns, rows, {1.0f, 1.0f}));
        return *std::max_element(angles.begin(), angles.end());
    };
    const float coarse = most(20, 10), fine = most(40, 20);
    EXPECT_NEAR(coarse / fine, 2.0f, 0.2f);
    EXPECT_NEAR(fine, 9.0f, 1.0f) << "180 degrees in twenty rows";
}

TEST(FalseColorScale, TiltHasTheRangeThatShadingKeeps) {
    const FalseColorScale scale = falseColorScale(plate({}), ViewMode::Tilt);
    EXPECT_TRUE(scale.meaningful);
    EXPECT_EQ(scale.high, kMaxTilt);
    EXPECT_EQ(scale.unit, "°");
}

} // namespace
} // namespace touchstone
