// The field of distances that the hand feels of a volume, against closed forms.
#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "engine/volume/volume_mesh.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/volume_to_field.h"
#include "haptics/tick/stepped_hand.h"
#include "tests/support/allocation_counter.h"
#include "tests/unit/volume/made_volume.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace touchstone {
namespace {

constexpr double kRadius = 0.2 * assets::kBallRadius, kCore = 0.2 * assets::kCoreRadius; // m
constexpr FieldReach kReach{.inside = 0.03, .outside = 0.01};

/// Places on a sphere, evenly.
std::vector<glm::dvec3> directions(int count) {
    std::vector<glm::dvec3> found;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - 2.0 * (i + 0.5) / count, angle = 2.399963229728653 * i;
        found.emplace_back(std::sqrt(1.0 - y * y) * std::cos(angle), y,
                           std::sqrt(1.0 - y * y) * std::sin(angle));
    }
    return found;
}

/// m, mean of |f - (|p| - radius)| over the sphere of radius + off about the origin.
double meanError(const VolumeField& field, double radius, double off) {
    const FieldShape shape(field.grid);
    const double unit = field.sceneFromObject.scale;
    double sum = 0.0;
    const auto all = directions(4000);
    for (const glm::dvec3& direction : all)
        sum += std::abs(unit * shape.value(field.sceneFromObject.inversePoint((radius + off) * direction)) -
                        off);
    return sum / static_cast<double>(all.size());
}

TEST(VolumeField, TheSurfaceOfTheBallIsOffByTheSquareOfTheVoxel) {
    std::printf("voxel mm  surface um  outside 5 mm um  inside 10 mm um\n");
    double coarsest = 0.0, finest = 0.0;
    for (const int voxels : {32, 48, 64, 96, 128}) {
        const VolumeField field =
            fieldOfVolume(*test::madeVolume("ball", glm::ivec3(voxels), "float"), 50.0, kReach, "ball");
        const double surface = meanError(field, kRadius, 0.0);
        std::printf("%8.3f  %10.3f  %15.1f  %15.1f\n", 200.0 / voxels, 1e6 * surface,
                    1e6 * meanError(field, kRadius, 0.005), 1e6 * meanError(field, kRadius, -0.010));
        (voxels == 32 ? coarsest : finest) = surface;
    }
    const double order = std::log(coarsest / finest) / std::log(4.0);
    std::printf("order %.2f\n", order);
    EXPECT_GT(order, 1.8);
    EXPECT_LT(order, 2.2);
}

TEST(VolumeField, IsADistanceInItsBand) {
    const VolumeField field =
        fieldOfVolume(*test::madeVolume("ball", glm::ivec3(96), "float"), 50.0, kReach, "ball");
    const FieldGrid& grid = *field.grid;
    double worst = 0.0, sum = 0.0;
    int count = 0;
    for (const glm::dvec3& direction : directions(2000))
        for (const double off : {-0.02, -0.01, -0.004, 0.0, 0.003, 0.006}) {
            const glm::dvec3 at =
                grid.gridFromObject(field.sceneFromObject.inversePoint((kRadius + off) * direction));
            const double steep = glm::length(grid.nodeGradient(glm::ivec3(glm::round(at))));
            worst = std::max(worst, std::abs(steep - 1.0));
            sum += std::abs(steep - 1.0);
            ++count;
        }
    std::printf("|grad f| is off 1 by %.4f at most, %.5f on average\n", worst, sum / count);
    EXPECT_LT(worst, 0.05);
}

TEST(VolumeField, TheValueChoosesTheSurface) {
    const auto volume = test::madeVolume("ball", glm::ivec3(64), "int16");
    EXPECT_LT(meanError(fieldOfVolume(*volume, 50.0, kReach, "ball"), kRadius, 0.0), 5e-5);
    EXPECT_LT(meanError(fieldOfVolume(*volume, 150.0, kReach, "ball"), kCore, 0.0), 1e-4);
    EXPECT_THROW((void)fieldOfVolume(*volume, 200.5, kReach, "ball"), Error);
    EXPECT_THROW((void)fieldOfVolume(*volume, 0.0, kReach, "ball"), Error);
}

TEST(VolumeField, SpacingAndAxesOfTheFileAreHonoured) {
    const double c = std::cos(0.4), s = std::sin(0.4);
    const glm::dmat3 turn({c, s, 0.0}, {-s, c, 0.0}, {0.0, 0.0, 1.0});
    for (const glm::ivec3 voxels : {glm::ivec3(64), glm::ivec3(80, 64, 48), glm::ivec3(64, 64, 32)})
        for (const glm::dmat3& axes : {glm::dmat3(1.0), turn}) {
            const VolumeField field =
                fieldOfVolume(*test::madeVolume("ball", voxels, "float", axes), 50.0, kReach, "ball");
            EXPECT_LT(meanError(field, kRadius, 0.0), 0.05 * 0.2 / 32) << voxels.x << " " << voxels.z;
        }
    // A gantry that leans: the ball becomes an ellipsoid, x' = x + 0.2 z.
    const glm::dmat3 leaning({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.2, 0.0, 1.0});
    const VolumeField field =
        fieldOfVolume(*test::madeVolume("ball", glm::ivec3(64), "float", leaning), 50.0, kReach, "ball");
    const FieldShape shape(field.grid);
    for (const glm::dvec3& direction : directions(500))
        EXPECT_NEAR(field.sceneFromObject.scale *
                        shape.value(field.sceneFromObject.inversePoint(leaning * (kRadius * direction))),
                    0.0, 0.1 * 0.2 / 64);
}

TEST(VolumeField, EndsAtTheVolumesBorder) {
    const auto volume = test::madeVolume("gyroid", glm::ivec3(48), "float");
    const VolumeField field = fieldOfVolume(*volume, 100.0, kReach, "gyroid");
    const FieldShape shape(field.grid);
    const double half = 0.1 * 47.0 / 48.0;
    int lids = 0;
    for (const glm::dvec3& direction : directions(2000)) {
        const glm::dvec3 p =
            direction *
            (half / std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)}));
        const double value = field.sceneFromObject.scale * shape.value(field.sceneFromObject.inversePoint(p));
        EXPECT_GE(value, -1e-6);
        const double inner =
            field.sceneFromObject.scale * shape.value(field.sceneFromObject.inversePoint(0.97 * p));
        if (assets::volumeValue("gyroid", p / 0.2) > 125.0 &&
            assets::volumeValue("gyroid", 0.97 * p / 0.2) > 125.0) { // well inside, under the lid
            ++lids;
            EXPECT_LT(value, 0.02 * 0.2 / 48); // of a voxel
            EXPECT_LT(inner, 0.0);
        }
    }
    EXPECT_GT(lids, 300);
}

TEST(VolumeField, NoiseIsFeltAtFewerNodes) {
    const auto volume = test::noise(glm::ivec3(40));
    const VolumeField all = fieldOfVolume(*volume, 128.0, kReach, "noise");
    EXPECT_EQ(all.coarser, 1.0);
    EXPECT_EQ(all.grid->layout().cells, glm::ivec3(43));
    const VolumeField few = fieldOfVolume(*volume, 128.0, kReach, "noise", {}, 20'000);
    EXPECT_EQ(few.mostNodes, 20'000.0);
    EXPECT_GT(few.coarser, 1.0);
    const glm::ivec3 nodes = few.grid->layout().cells + 1;
    EXPECT_LE(nodes.x * nodes.y * nodes.z, 20'000);
}

TEST(VolumeField, EyeAndHandMeetTheSameSurface) {
    for (const char* name : {"head", "gyroid"}) {
        const auto volume = test::madeVolume(name, {64, 64, 48}, "int16");
        const double iso = volume->defaultIso();
        const SurfaceMesh mesh = meshOfVolume(*volume, iso, name);
        const VolumeField field = fieldOfVolume(*volume, iso, kReach, name);
        const FieldShape shape(field.grid);
        double worst = 0.0, sum = 0.0;
        for (const glm::vec3& p : mesh.positions) {
            const double off = std::abs(shape.value(field.sceneFromObject.inversePoint(glm::dvec3(p))));
            worst = std::max(worst, off / field.grid->layout().voxel);
            sum += off / field.grid->layout().voxel;
        }
        std::printf("%s: the mesh lies %.3f voxels off the field on average, %.3f at most\n", name,
                    sum / static_cast<double>(mesh.positions.size()), worst);
        EXPECT_LT(sum / static_cast<double>(mesh.positions.size()), 0.1);
    }
}

/// Voxels between the mesh and the field: on average over the mesh's vertices.
double meanGap(const Volume& volume, double iso) {
    const SurfaceMesh mesh = meshOfVolume(volume, iso, "volume");
    const VolumeField field = fieldOfVolume(volume, iso, kReach, "volume");
    const FieldShape shape(field.grid);
    double sum = 0.0;
    for (const glm::vec3& p : mesh.positions)
        sum += std::abs(shape.value(field.sceneFromObject.inversePoint(glm::dvec3(p)))) /
               field.grid->layout().voxel;
    return sum / static_cast<double>(mesh.positions.size());
}

TEST(VolumeField, VoxelsAtTheValueItselfAreInsideForEyeAndHand) {
    // A mask, and a plateau of half of the head's voxels.
    std::vector<float> mask;
    for (int i = 0; i < 40 * 40 * 40; ++i)
        mask.push_back(glm::length(glm::dvec3(i % 40, i / 40 % 40, i / 1600) - 19.5) < 15.0 ? 1.0f : 0.0f);
    const auto ball = test::volumeOf(glm::ivec3(40), mask);
    const auto head = test::madeVolume("head", glm::ivec3(64), "int16");
    const double ofMask = meanGap(*ball, 1.0), ofHead = meanGap(*head, 40.0);
    std::printf("the mesh lies off the field by %.4f voxels of a mask, %.4f of a plateau\n", ofMask, ofHead);
    EXPECT_LT(ofMask, 0.15);
    EXPECT_LT(ofHead, 0.15);
    // The mask's ball, not the cubes of blocks of voxels.
    for (const glm::vec3& p : meshOfVolume(*ball, 1.0, "mask").positions) {
        const double radius = 1e3 * glm::length(glm::dvec3(p) - 0.0195);
        ASSERT_GT(radius, 13.0);
        ASSERT_LT(radius, 15.0);
    }
    const FieldShape shape(fieldOfVolume(*ball, 1.0, kReach, "mask").grid);
    EXPECT_LT(shape.value({0.0, 0.0, 0.0}), -0.2) << "solid for the hand";
}

TEST(VolumeField, TheLongestAxisHasNodesEnough) {
    const glm::ivec3 size(1 << 16, 3, 3); // and a margin
    std::vector<float> values(static_cast<size_t>(size.x) * 9, 0.0f);
    values[values.size() / 2] = 1.0f;
    const VolumeField field = fieldOfVolume(*test::volumeOf(size, values), 0.5, kReach, "needle");
    EXPECT_LE(field.grid->layout().cells.x, FieldGrid::kMostOnAxis);
    EXPECT_GT(field.coarser, 1.0);
}

TEST(VolumeField, TwoSlicesAreFeltWhereTheyAreSeen) {
    std::vector<float> values;
    for (int i = 0; i < 50 * 50 * 2; ++i)
        values.push_back(static_cast<float>(20.0 - glm::length(glm::dvec2(i % 50, i / 50 % 50) - 24.5)));
    const auto slab = test::volumeOf({50, 50, 2}, values);
    EXPECT_LT(meanGap(*slab, 0.0), 0.1);
    const FieldShape shape(fieldOfVolume(*slab, 0.0, kReach, "slab").grid);
    EXPECT_LE(shape.value({0.0, 0.0, 0.0}), 0.0);
}

/// The phantom as a compiled scene.
struct Head {
    Head() : path(std::filesystem::temp_directory_path() / ("head_" + std::to_string(::getpid()) + ".nrrd")) {
        const std::vector<std::byte> bytes =
            assets::nrrdOf(assets::makeVolume("head", glm::ivec3(64), "int16"));
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        scene = loadScene(path);
        std::filesystem::remove(path);
        haptic = compileHapticScene(*scene, workspaceFromScene(*scene, Fit::Workspace));
    }
    std::filesystem::path path;
    ScenePtr scene;
    std::shared_ptr<const HapticScene> haptic;
};

TEST(VolumeField, TheHeadIsTouchedWithoutAnAllocation) {
    const Head head;
    ASSERT_EQ(head.haptic->objects.size(), 1u);
    ASSERT_NE(head.haptic->objects[0]->shape, nullptr);
    SteppedHand hand(*head.haptic);
    HapticSettings settings;
    const double scale = head.haptic->workspaceFromScene.scale;
    int touching = 0;
    double deepest = 0.0;
    const uint64_t before = test::allocationsOnThisThread();
    for (int i = 0; i < 6000; ++i) { // down onto the skull, then round
        const double angle = 1e-3 * std::max(0, i - 1000), height = std::max(0.075 - 1e-4 * i, 0.050);
        const glm::dvec3 hip(0.02 * std::sin(angle), height, 0.02 * std::cos(angle) - 0.02);
        const HapticOutput& out = hand.tick(settings, sampleAt(hip), 1e-3 * i, 1e-3);
        touching += out.contacts > 0 ? 1 : 0;
        const auto& shape = *head.haptic->objects[0]->shape;
        const glm::dvec3 proxy = head.haptic->objects[0]->workspaceFromObject.inversePoint(out.proxy);
        deepest = std::min(deepest, static_cast<const FieldShape&>(shape).value(proxy));
    }
    EXPECT_EQ(test::allocationsOnThisThread() - before, 0u);
    EXPECT_GT(touching, 4000);
    EXPECT_GT(deepest, -1e-9) << "the proxy stays outside";
    EXPECT_GT(scale, 0.0);
}

} // namespace
} // namespace touchstone
