// The long form of exactness_test.cpp: what docs/architecture.md quotes.

#include "tests/property/exact_cases.h"
#include "tests/property/hard_shapes.h"
#include "tests/support/shared_files.h"

#include <gtest/gtest.h>

namespace touchstone::test {
namespace {

TEST(ExactnessSweep, OurShapes) {
    std::vector<ExactFigures> strokes;
    for (const StrokeCase& c : strokeCases())
        strokes.push_back(runStroke(c, 5000));
    expectExact("strokes in closed form", strokes);
    for (const auto& [name, shape] : {std::pair{"sphere1800", assets::sphere(0.05, 30, 30)},
                                      {"torus6480", assets::torus(0.06, 0.025, 72, 45)},
                                      {"torus64800", assets::torus(0.06, 0.025, 180, 180)}}) {
        std::vector<ExactFigures> all;
        for (const HandCase& c : handsOver(name, 5000))
            all.push_back(runHand(c, sceneOf(shape), Fit::Workspace));
        expectExact(name, all);
    }
}

TEST(ExactnessSweep, AMillionTriangles) {
    std::vector<ExactFigures> all;
    const Scene scene = sceneOf(assets::torus(0.06, 0.025, 1000, 500));
    ASSERT_EQ(scene.triangleCount(), 1000000u);
    for (HandCase c : handsOver("torus1M", 2000, 0.2)) {
        all.push_back(runHand(c, scene, Fit::Workspace));
        EXPECT_GE(all.back().compared, 180) << c.name;
    }
    expectExact("torus1M", all);
}

TEST(ExactnessSweep, HardShapes) {
    for (const HardShape& hard : hardShapes()) {
        std::vector<ExactFigures> all;
        for (const HandCase& c : handsOver(hard.name, 2000))
            all.push_back(runHand(c, sceneOf(hard.shape), Fit::Workspace));
        expectExact(hard.name, all);
    }
}

TEST(ExactnessSweep, SceneFiles) {
    for (const auto& file : gltfFilesIn(TOUCHSTONE_ASSETS))
        expectExact(file.stem().string(), runFile(file, 1000));
}

TEST(ExactnessSweep, SharedModels) {
    const auto models = modelsFolder();
    if (!models)
        GTEST_SKIP() << kNoModels;
    for (const auto& file : gltfFilesIn(*models))
        expectExact(file.stem().string(), runFile(file, 1000));
}

} // namespace
} // namespace touchstone::test
