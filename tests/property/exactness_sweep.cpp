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
        expectExact(name, runHands(handsOver(name, 5000), sceneOf(shape)));
    }
}

TEST(ExactnessSweep, AMillionTriangles) {
    const Scene scene = sceneOf(assets::torus(0.06, 0.025, 1000, 500));
    ASSERT_EQ(scene.triangleCount(), 1000000u);
    const std::vector<ExactFigures> all = runHands(handsOver("torus1M", 2000, 0.2), scene);
    for (const ExactFigures& figures : all)
        EXPECT_GE(figures.compared, 180) << figures.name;
    expectExact("torus1M", all);
}

TEST(ExactnessSweep, HardShapes) {
    for (const HardShape& hard : hardShapes())
        expectExact(hard.name, runHands(handsOver(hard.name, 2000), sceneOf(hard.shape)));
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
