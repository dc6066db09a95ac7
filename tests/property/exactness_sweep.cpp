// The long form of exactness_test.cpp: what docs/architecture.md quotes.

#include "tests/property/exact_cases.h"

#include <gtest/gtest.h>

namespace touchstone::test {
namespace {

TEST(ExactnessSweep, OurShapes) {
    std::vector<ExactFigures> all;
    for (const StrokeCase& c : strokeCases())
        all.push_back(runStroke(c, 5000));
    for (const auto& [name, shape] : {std::pair{"sphere1800", assets::sphere(0.05, 30, 30)},
                                      {"torus6480", assets::torus(0.06, 0.025, 72, 45)},
                                      {"torus64800", assets::torus(0.06, 0.025, 180, 180)}})
        for (const HandCase& c : handsOver(name, 5000))
            all.push_back(runHand(c, sceneOf(shape), Fit::Workspace));
    expectExact(all);
}

TEST(ExactnessSweep, AMillionTriangles) {
    std::vector<ExactFigures> all;
    const Scene scene = sceneOf(assets::torus(0.06, 0.025, 1000, 500));
    ASSERT_EQ(scene.triangleCount(), 1000000u);
    for (HandCase c : handsOver("torus1M", 2000, 0.2)) {
        all.push_back(runHand(c, scene, Fit::Workspace));
        EXPECT_GE(all.back().compared, 180) << c.name;
    }
    expectExact(all);
}

TEST(ExactnessSweep, SceneFiles) {
    for (const auto& file : sceneFiles())
        expectExact(runFile(file, 1000));
}

} // namespace
} // namespace touchstone::test
