// How exact the proxy is: every tick against the oracle and against invariants. The long form is in
// exactness_sweep.cpp.

#include "engine/load/scene_loader.h"
#include "tests/property/exact_cases.h"
#include "tests/property/hard_shapes.h"
#include "tests/support/gltf_maker.h"
#include "tests/support/shared_files.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

namespace touchstone::test {
namespace {

TEST(Soup, FindsWhatTheLoopOverAllTrianglesFinds) {
    for (const auto& shape : {assets::torus(0.06, 0.025, 40, 30), assets::sphere(0.05, 30, 30),
                              assets::box({1000.0, 0.1, 10.0}, 6)}) {
        const auto scene = compileHapticScene(sceneOf(shape), Similarity{});
        const HapticObject& object = *scene->objects[0];
        const Soup soup(*scene, 0);
        std::mt19937 random(5);
        std::uniform_real_distribution<double> in(-0.6, 0.6), size(-4.0, -0.5);
        size_t found = 0;
        for (int trial = 0; trial < 40; ++trial) {
            LVec3 p(in(random), in(random), in(random));
            if (trial % 2 == 0)
                p = LVec3(object.vertices[random() % (object.vertices.size() - 1)]) * (1.0L + 1e-4L * p.x);
            const auto reach = static_cast<long double>(std::pow(10.0, size(random)));
            long double nearest = INFINITY;
            size_t count = 0;
            for (size_t t = 0; t < object.triangleCount(); ++t) {
                const auto corner = [&](size_t k) {
                    return LVec3(object.vertices[object.indices[3 * t + k]]);
                };
                const long double distance = distanceFrom({corner(0), corner(1), corner(2)}, p).distance;
                nearest = std::min(nearest, distance);
                count += distance <= reach ? 1 : 0;
            }
            EXPECT_EQ(soup.nearest(p).distance, nearest);
            EXPECT_EQ(bruteNearest(object, p).distance, nearest);
            EXPECT_EQ(soup.within(p, reach).size(), count);
            EXPECT_EQ(bruteWithin(object, p, reach).size(), count);
            found += count;
            // A way's clearance is that of its nearest place.
            const LVec3 q = p + LVec3(0.03L * p.y, 0.02L * p.z, -0.05L * p.x);
            long double least = INFINITY;
            for (int i = 0; i <= 50; ++i)
                least = std::min(least, bruteNearest(object, p + (q - p) * (0.02L * i)).distance);
            const long double clearance = soup.clearance(p, q, 1.0L);
            EXPECT_LE(clearance, least);
            EXPECT_GT(clearance, least - 0.02L * glm::length(q - p));
        }
        EXPECT_GT(found, 100u);
    }
}

TEST(Exactness, StrokesOverOurShapes) {
    std::vector<ExactFigures> all;
    for (const StrokeCase& c : strokeCases())
        all.push_back(runStroke(c, c.ticks));
    expectExact("strokes in closed form", all);
}

TEST(Exactness, HandsOverOurShapes) {
    std::vector<ExactFigures> all;
    for (const auto& [name, shape] : {std::pair{"sphere1800", assets::sphere(0.05, 30, 30)},
                                      {"torus6480", assets::torus(0.06, 0.025, 72, 45)},
                                      {"torus64800", assets::torus(0.06, 0.025, 180, 180)}})
        for (ExactFigures& figures : runHands(handsOver(name, 300), sceneOf(shape)))
            all.push_back(std::move(figures));
    expectExact("our shapes", all);
}

glm::dmat4 placedAt(double scale, const glm::dvec3& offset) {
    const glm::dmat4 turned = glm::mat4_cast(glm::normalize(glm::dquat(0.8, 0.1, -0.5, 0.3)));
    glm::dmat4 matrix = turned * glm::dmat4(glm::dmat3(scale));
    matrix[3] = glm::dvec4(offset, 1.0);
    return matrix;
}

const glm::dvec3 kFar(1e6, -7e5, 3e5);

TEST(Exactness, ScalesAndFarNodes) {
    std::vector<ExactFigures> all;
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const bool far : {false, true})
            for (const Fit fit : {Fit::None, Fit::Workspace})
                for (const double radius : {0.0, 0.5e-3}) {
                    const glm::dmat4 place = placedAt(scale, far ? kFar : glm::dvec3(0.0));
                    Scene scene = sceneOf(assets::torus(0.06, 0.025, 72, 45), place);
                    char name[64];
                    std::snprintf(name, sizeof name, "torus %g%s%s%s", scale, far ? " far" : "",
                                  fit == Fit::None ? " bare" : " fit", radius > 0.0 ? " r.5" : " r0");
                    ExactScene alone(scene, fit);
                    all.push_back(runHand({name, radius, 0.3, 60}, alone));
                    const long double error = vertexError(scene, fit);
                    EXPECT_LT(error, 1e-6L) << name;
                    std::printf("%-28s vertices within %.1Le diagonals\n", name, error);
                    // Two that overlap: edges where both are touched.
                    addShape(scene, assets::sphere(0.05, 30, 30),
                             place * glm::translate(glm::dmat4(1.0), glm::dvec3(0.05, 0.02, 0.0)));
                    ExactScene both(scene, fit);
                    all.push_back(runHand({std::string(name) + " +sphere", radius, 0.3, 60}, both));
                }
    expectExact("scales and far nodes", all);
}

/// A sphere of 1800 triangles under two nodes, the outer of which stands 1000 km away.
GltfMaker farSphere(double scale) {
    const assets::Shape shape = assets::sphere(0.05, 30, 30);
    std::vector<float> positions;
    for (const glm::vec3& p : shape.positions)
        positions.insert(positions.end(), {p.x, p.y, p.z});
    GltfMaker maker;
    const size_t position = maker.addAccessor<float>(positions, "VEC3");
    maker.json["accessors"][position]["min"] = {-0.05, -0.05, -0.05};
    maker.json["accessors"][position]["max"] = {0.05, 0.05, 0.05};
    const size_t indices = maker.addAccessor<uint32_t>(shape.indices, "SCALAR");
    maker.append("meshes",
                 {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", indices}}}}});
    const size_t inner = maker.append(
        "nodes", {{"mesh", 0}, {"rotation", {0.0, 0.6, 0.0, 0.8}}, {"scale", {scale, 0.75 * scale, scale}}});
    const size_t outer =
        maker.append("nodes", {{"children", {inner}}, {"translation", {kFar.x, kFar.y, kFar.z}}});
    maker.json["scenes"] = {{{"nodes", {outer}}}};
    return maker;
}

TEST(Exactness, AFileWithAFarNode) {
    std::vector<ExactFigures> all;
    for (const double scale : {1e-3, 1.0, 1e3}) {
        const ScenePtr scene = loadSceneFromMemory(farSphere(scale).glb(), ".");
        ASSERT_EQ(scene->triangleCount(), 1800u);
        EXPECT_NEAR(scene->bounds.centre().x, kFar.x, 1e-4 * scale);
        for (const Fit fit : {Fit::None, Fit::Workspace}) {
            char name[64];
            std::snprintf(name, sizeof name, "far file %g%s", scale, fit == Fit::None ? " bare" : " fit");
            const long double error = vertexError(*scene, fit);
            std::printf("%-28s vertices within %.1Le diagonals\n", name, error);
            EXPECT_LT(error, 1e-6L) << name;
            ExactScene placed(*scene, fit);
            all.push_back(runHand({name, 0.5e-3, 0.3, 100}, placed));
        }
    }
    expectExact("far file", all);
}

TEST(Exactness, HandsOverHardShapes) {
    std::vector<ExactFigures> all;
    for (const HardShape& hard : hardShapes())
        for (ExactFigures& figures : runHands(handsOver(hard.name, 150), sceneOf(hard.shape)))
            all.push_back(std::move(figures));
    expectExact("hard shapes", all);
}

TEST(Exactness, HandsOverSceneFiles) {
    for (const auto& file : gltfFilesIn(TOUCHSTONE_ASSETS))
        expectExact(file.stem().string(), runFile(file, 100));
}

TEST(Exactness, HandsOverSharedModels) {
    const auto models = modelsFolder();
    if (!models)
        GTEST_SKIP() << kNoModels;
    for (const auto& file : gltfFilesIn(*models))
        expectExact(file.stem().string(), runFile(file, 100));
}

} // namespace
} // namespace touchstone::test
