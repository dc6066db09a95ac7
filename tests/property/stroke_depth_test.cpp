#include "assets/shapes.h"
#include "devices/stroke/stroke_library.h"
#include "engine/load/scene_loader.h"
#include "tests/property/stroke_depth.h"
#include "tests/support/felt_stroke.h"
#include "tests/support/shared_files.h"
#include "tests/support/stroke_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {
namespace {

void expectStrokesOn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
            files.push_back(entry.path());
    std::ranges::sort(files);
    ASSERT_FALSE(files.empty()) << folder;
    for (const std::filesystem::path& file : files) {
        LoadOptions options; // the bare surface is felt
        options.images = {.visual = false, .haptic = false};
        const ScenePtr scene = loadScene(file, options);
        if (scene->touchable())
            test::expectStrokes(scene, file.filename().string());
    }
}

TEST(StrokeDepth, OurScenes) {
    expectStrokesOn(TOUCHSTONE_ASSETS);
}

TEST(StrokeDepth, SharedModels) {
    const auto folder = test::modelsFolder();
    if (!folder)
        GTEST_SKIP() << test::kNoModels;
    expectStrokesOn(*folder);
}

/// Front and back lie in one place: rays counted one of them, and all space behind it was taken for its
/// inside, where nothing is felt.
TEST(StrokeDepth, APlateWithoutThicknessIsTouchedFromBothSides) {
    const auto scene = std::make_shared<Scene>(test::strokeScene(assets::box({0.1, 0.1, 0.0})));
    const Similarity fit = workspaceFromScene(*scene, Fit::Workspace);
    const auto haptic = compileHapticScene(*scene, fit, {});
    for (const double side : {1.0, -1.0})
        for (const StrokeInfo& info : strokeInfos()) {
            SCOPED_TRACE(std::string(info.name) + (side > 0.0 ? ", front" : ", back"));
            const StrokePath path =
                layStroke(*scene, fit, {.name = std::string(info.name), .front = {0.0, 0.0, side}});
            const test::FeltStroke felt = test::feel(*haptic, path);
            EXPECT_GT(felt.contact, 0);
            EXPECT_FALSE(felt.inside);
            EXPECT_LE(felt.deepest, test::kDepthFactor * info.depth);
        }
}

TEST(StrokeDepth, WhatIsFeltFromItsFrontIsStrokedThere) {
    auto scene = std::make_shared<Scene>(test::strokeScene(assets::plane(0.1, 0.1, 3, 3))); // faces +y
    scene->materials[0].haptic.sides = SideChoice::Front;
    const Similarity fit = workspaceFromScene(*scene, Fit::Workspace);
    const auto haptic = compileHapticScene(*scene, fit, {});
    for (const StrokeInfo& info : strokeInfos()) {
        SCOPED_TRACE(info.name);
        const StrokePath path =
            layStroke(*scene, fit, {.name = std::string(info.name), .front = {0.0, -1.0, 0.0}});
        const test::FeltStroke felt = test::feel(*haptic, path);
        EXPECT_GT(felt.contact, 0);
        EXPECT_LE(felt.deepest, test::kDepthFactor * info.depth);
    }
}

TEST(StrokeDepth, RandomShapes) {
    for (uint32_t seed = 0; seed < 70; ++seed) {
        const test::StrokeShape shape = test::strokeShape(seed);
        test::expectStrokes(std::make_shared<const Scene>(shape.scene),
                            shape.name + " " + std::to_string(seed));
    }
}

} // namespace
} // namespace touchstone
