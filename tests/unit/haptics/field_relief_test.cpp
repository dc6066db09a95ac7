// Noise and lattice in the values of a field [002 section 4.4].

#include "assets/shapes.h"
#include "haptics/shape/field/field_relief.h"
#include "haptics/shape/field/mesh_to_field.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace touchstone::test::field_relief_test {
namespace {

/// Mean, deviation and the shares of one and two deviations of the normal distribution, and no correlation
/// between neighbours.
TEST(FieldRelief, TheNoiseIsGaussianAndWhite) {
    constexpr int kSide = 48;
    double sum = 0.0, squares = 0.0, along = 0.0;
    int within1 = 0, within2 = 0, different = 0;
    for (int z = -kSide / 2; z < kSide / 2; ++z)
        for (int y = -kSide / 2; y < kSide / 2; ++y)
            for (int x = -kSide / 2; x < kSide / 2; ++x) {
                const double g = gaussianAt(7, {x, y, z});
                sum += g;
                squares += g * g;
                along += g * (gaussianAt(7, {x + 1, y, z}) + gaussianAt(7, {x, y + 1, z}) +
                              gaussianAt(7, {x, y, z + 1}));
                within1 += std::abs(g) < 1.0 ? 1 : 0;
                within2 += std::abs(g) < 2.0 ? 1 : 0;
                different += g != gaussianAt(8, {x, y, z}) ? 1 : 0;
                EXPECT_LE(std::abs(g), FieldRelief::kMostDeviations);
            }
    constexpr double kCount = kSide * kSide * kSide; // 110,592: the mean's own deviation is 0.003
    EXPECT_NEAR(sum / kCount, 0.0, 0.012);
    EXPECT_NEAR(squares / kCount, 1.0, 0.017);
    EXPECT_NEAR(along / (3.0 * kCount), 0.0, 0.01);
    EXPECT_NEAR(within1 / kCount, 0.6827, 0.006);
    EXPECT_NEAR(within2 / kCount, 0.9545, 0.003);
    EXPECT_EQ(different, kCount);
}

/// At its values the noise is they themselves; between them it has the same deviation and no jump.
TEST(FieldRelief, NoiseOfAWavelengthHasOneDeviationEverywhere) {
    const FieldRelief relief{.noise = 0.5, .noiseWavelength = 0.1, .seed = 3};
    EXPECT_NEAR(reliefAt(relief, {0.2, -0.3, 0.1}, glm::ivec3(99)), 0.5 * gaussianAt(3, {2, -3, 1}), 1e-9);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-40.0, 40.0);
    double squares = 0.0;
    constexpr int kCount = 40000;
    for (int i = 0; i < kCount; ++i) {
        const glm::dvec3 at(place(random), place(random), place(random));
        const double height = reliefAt(relief, at, glm::ivec3(0));
        squares += height * height;
        EXPECT_NEAR(reliefAt(relief, at + glm::dvec3(1e-9), glm::ivec3(0)), height, 1e-7);
    }
    EXPECT_NEAR(std::sqrt(squares / kCount), 0.5, 0.01);
    for (double x = -0.3; x < 0.31; x += 0.1) // across the faces of its cells
        EXPECT_NEAR(reliefAt(relief, {x - 1e-12, 0.03, 0.07}, glm::ivec3(0)),
                    reliefAt(relief, {x + 1e-12, 0.03, 0.07}, glm::ivec3(0)), 1e-9);
}

HapticObject meshOf(const Scene& scene) {
    const TouchBench bench(scene);
    return *bench.scene->objects[0];
}

/// Against the formula in long double, at every node that the relief is laid on whole.
TEST(FieldRelief, IsLaidOnTheNodesByItsFormula) {
    const HapticObject mesh = meshOf(sceneOf(assets::sphere(0.075, 60, 60)));
    FieldRequest request{.voxel = 1.0 / 64.0, .inside = 0.2, .outside = 0.15};
    request.relief = {.noise = 0.002, .seed = 4, .lattice = 0.01, .latticeWavelength = 0.25};
    const auto textured = fieldOfMesh(mesh, request);
    FieldRequest without = request;
    without.relief = {};
    const auto plain = fieldOfMesh(mesh, without);
    ASSERT_EQ(textured->layout().cells, plain->layout().cells);
    const FieldLayout& layout = plain->layout();
    const double full = request.relief.highest() + 2.0 * request.voxel;
    int checked = 0, flat = 0;
    for (int z = 0; z <= layout.cells.z; ++z)
        for (int y = 0; y <= layout.cells.y; ++y)
            for (int x = 0; x <= layout.cells.x; ++x) {
                const double f = plain->node({x, y, z}), g = textured->node({x, y, z});
                if (f >= static_cast<double>(static_cast<float>(plain->outside())) ||
                    f <= static_cast<double>(static_cast<float>(-plain->inside()))) {
                    EXPECT_EQ(g, f) << "beyond the field's reach";
                    ++flat;
                }
                if (std::abs(f) > full)
                    continue;
                const std::array<long double, 3> place{
                    layout.origin.x + static_cast<long double>(layout.voxel) * x,
                    layout.origin.y + static_cast<long double>(layout.voxel) * y,
                    layout.origin.z + static_cast<long double>(layout.voxel) * z};
                long double waves = 0.0L;
                for (const long double p : place)
                    waves += std::cos(2.0L * std::numbers::pi_v<long double> * p / 0.25L);
                const long double height = 0.01L / 3.0L * waves + 0.002L * gaussianAt(4, {x, y, z});
                EXPECT_NEAR(g, static_cast<double>(f - height), 1e-7);
                ++checked;
            }
    EXPECT_GT(checked, 10000);
    EXPECT_GT(flat, 10000);
}

/// A hand that strokes a face 1 mm deep finds its proxy where the formula puts the surface.
TEST(FieldRelief, IsFeltWhereTheFormulaPutsTheSurface) {
    constexpr double kAmplitude = 0.0006, kWave = 0.012, kTop = 0.02; // m
    Scene scene = sceneOf(assets::box(glm::dvec3(2.0 * kTop)));
    HapticMaterial& haptic = scene.materials[0].haptic;
    haptic.implicit = true;
    haptic.voxelSize = 0.0005f;
    haptic.fieldTexture = {.latticeAmplitude = static_cast<float>(kAmplitude),
                           .latticeWavelength = static_cast<float>(kWave)};
    TouchBench bench(scene, cornerSettings());
    EXPECT_TRUE(bench.scene->warnings.empty());
    bench.settings.proxyRadius = 0.0;
    const auto heightAt = [&](const glm::dvec3& p) {
        const glm::dvec3 waves = glm::cos(2.0 * std::numbers::pi / kWave * p);
        return kAmplitude / 3.0 * (waves.x + waves.y + waves.z);
    };
    double lowest = 1.0, highest = -1.0;
    int touched = 0;
    const auto check = [&](const HapticOutput& output) {
        if (output.contacts == 0)
            return;
        EXPECT_NEAR(output.proxy.y, kTop + heightAt(output.proxy), 1e-5) << output.proxy.x;
        lowest = std::min(lowest, output.proxy.y);
        highest = std::max(highest, output.proxy.y);
        ++touched;
    };
    bench.moveTo({-0.007, kTop + 0.002, 0.0}, 0.05);
    bench.moveTo({-0.007, kTop - 0.001, 0.0}, 0.05, check);
    bench.moveTo({0.007, kTop - 0.001, 0.0}, 0.05, check);
    EXPECT_GT(touched, 250);
    // The crests are higher and the troughs lower, since the waves along y change with the height, too.
    EXPECT_NEAR(highest - lowest, 2.0 * kAmplitude / 3.0, 6e-5);
}

/// The voxel that keeps a field within an error is that of the field without its texture.
TEST(FieldRelief, StandsOnAFieldThatKeepsAnError) {
    Scene scene = sceneOf(assets::sphere(0.075, 60, 60));
    HapticMaterial& haptic = scene.materials[0].haptic;
    haptic.implicit = true;
    haptic.fieldError = 4e-4f;
    const TouchBench plain(scene);
    haptic.fieldTexture = {.noiseAmplitude = 0.0005f, .noiseWavelength = 0.02f, .noiseSeed = 2.0f};
    const TouchBench textured(scene);
    EXPECT_TRUE(textured.scene->warnings.empty());
    const auto gridOf = [](const TouchBench& bench) -> const FieldGrid& {
        return dynamic_cast<const FieldShape&>(*bench.scene->objects[0]->shape).grid();
    };
    EXPECT_EQ(gridOf(textured).layout().voxel, gridOf(plain).layout().voxel);
    EXPECT_NE(gridOf(textured).hash(), gridOf(plain).hash());
    haptic.fieldTexture.noiseSeed = 3.0f;
    EXPECT_NE(gridOf(TouchBench(scene)).hash(), gridOf(textured).hash()) << "another seed, another noise";
    haptic.fieldTexture.noiseSeed = 2.0f;
    EXPECT_EQ(gridOf(TouchBench(scene)).hash(), gridOf(textured).hash());
}

TEST(FieldRelief, WarnsOfWavesTooShortForTheGridAndOfHeightsTooLargeForTheObject) {
    Scene scene = sceneOf(assets::sphere(0.075, 40, 40));
    HapticMaterial& haptic = scene.materials[0].haptic;
    haptic.implicit = true;
    haptic.voxelSize = 0.003f;
    haptic.fieldTexture = {.latticeAmplitude = 0.0005f, .latticeWavelength = 0.002f};
    const TouchBench coarse(scene);
    ASSERT_EQ(coarse.scene->warnings.size(), 1u);
    EXPECT_EQ(coarse.scene->warnings[0].place, "materials[0].latticeWavelength");
    for (const float amplitude : {0.02f, 3e38f}) {
        haptic.fieldTexture = {.noiseAmplitude = amplitude};
        const TouchBench high(scene);
        ASSERT_EQ(high.scene->warnings.size(), 1u) << amplitude;
        EXPECT_EQ(high.scene->warnings[0].place, "materials[0].noiseAmplitude");
    }
    haptic.fieldTexture = {.latticeAmplitude = 0.0f, .latticeWavelength = 0.002f};
    EXPECT_TRUE(TouchBench(scene).scene->warnings.empty());
    // Values nearer to each other than the nodes: each node has its own.
    haptic.fieldTexture = {.noiseAmplitude = 0.0003f, .noiseWavelength = 1e-30f};
    const TouchBench white(scene);
    EXPECT_NE(white.scene->objects[0]->shape, nullptr);
}

} // namespace
} // namespace touchstone::test::field_relief_test
