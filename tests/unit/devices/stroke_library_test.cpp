#include "assets/shapes.h"
#include "devices/simulated/simulated_hand.h"
#include "devices/stroke/stroke_library.h"
#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "haptics/scene/haptic_scene.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/felt_stroke.h"
#include "tests/support/shared_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {
namespace {

constexpr double kTick = 0.001;
constexpr double kLanding =
    0.08; // m/s, the fastest that a hand comes down where its stroke says nothing else

std::vector<glm::dvec3> corners(const assets::Shape& shape) {
    std::vector<glm::dvec3> result;
    for (const uint32_t index : shape.indices)
        result.emplace_back(shape.positions[index]);
    return result;
}

StrokePath laid(const std::vector<glm::dvec3>& triangles, const std::string& name,
                const std::optional<StrokePlace>& place = {}) {
    return layStroke(triangles, {.name = name, .place = place});
}

void expectEveryStrokeTouches(const std::filesystem::path& folder) {
    size_t files = 0;
    for (const std::filesystem::path& file : test::gltfFilesIn(folder)) {
        if (file.parent_path() != folder)
            continue;
        ++files;
        LoadOptions options; // the bare surface is felt
        options.images = {.visual = false, .haptic = false};
        const ScenePtr scene = loadScene(file, options);
        const Similarity fit = workspaceFromScene(*scene, Fit::Workspace);
        const auto haptic = compileHapticScene(*scene, fit, {});
        for (const StrokeInfo& info : strokeInfos()) {
            SCOPED_TRACE(file.filename().string() + ", " + std::string(info.name));
            const StrokePath path = layStroke(*scene, fit, {.name = std::string(info.name)});
            const test::FeltStroke felt = test::feel(*haptic, path);
            EXPECT_FALSE(felt.began) << "it begins in the air";
            EXPECT_FALSE(felt.inside);
            EXPECT_GT(felt.contact, 0.15 * felt.ticks);
            EXPECT_GT(felt.deepest, 0.9 * info.depth);
            // Creases are pressed deeper; over an edge with little room (the barrel's) the hand is clumsy.
            EXPECT_LT(felt.deepest, (info.name == "edge" ? 4.0 : 2.5) * info.depth);
            EXPECT_LE(felt.fastest, std::max(info.speed, kLanding) * (1 + 1e-9));
            EXPECT_LE(felt.fastestInTouch, info.speed * (1 + 1e-9));
            EXPECT_LT(felt.jerkiest, 150.0) << "m/s²: the velocity has no steps";
            for (const double t : {0.0, 0.31, 0.77})
                EXPECT_LT(glm::distance(path.position(t), path.position(t + 20.0 * path.period())), 1e-9);
        }
    }
    EXPECT_GT(files, 0u);
}

TEST(StrokeLibrary, EveryStrokeTouchesOurScenesAsItSays) {
    expectEveryStrokeTouches(TOUCHSTONE_ASSETS);
}

TEST(StrokeLibrary, EveryStrokeTouchesTheSharedModelsAsItSays) {
    const auto models = test::modelsFolder();
    if (!models)
        GTEST_SKIP() << test::kNoModels;
    expectEveryStrokeTouches(*models);
}

TEST(StrokeLibrary, IsTheSameEveryTimeAndAllocatesNothingOnTheWay) {
    const auto shape = corners(assets::torus(0.06, 0.025, 40, 40));
    for (const StrokeInfo& info : strokeInfos()) {
        SCOPED_TRACE(info.name);
        SimulatedHand one(std::make_shared<const StrokePath>(laid(shape, std::string(info.name))));
        SimulatedHand other(std::make_shared<const StrokePath>(laid(shape, std::string(info.name))));
        const uint64_t before = test::allocationsOnThisThread();
        bool same = true;
        for (int tick = 0; tick < 10000; ++tick)
            same = same && one.sample(tick * kTick).position == other.sample(tick * kTick).position;
        EXPECT_EQ(test::allocationsOnThisThread(), before);
        EXPECT_TRUE(same);
    }
}

TEST(StrokeLibrary, StrokesAroundTheTouchedPoint) {
    const auto shape = corners(assets::sphere(0.05, 120, 120));
    const glm::dvec3 out = glm::normalize(glm::dvec3(1.0, 0.4, -0.7));
    for (const StrokeInfo& info : strokeInfos()) {
        if (info.name == "tour" || info.name == "edge")
            continue; // these have places of their own
        SCOPED_TRACE(info.name);
        const StrokePath path = laid(shape, std::string(info.name), StrokePlace{0.05 * out, 2.0 * out});
        const double reach =
            info.name == "fast" ? 0.036 : 0.021; // in the air, over a surface that falls away
        double nearest = 1.0;
        for (double t = 0.0; t < path.period(); t += kTick) {
            const glm::dvec3 p = path.position(t);
            const glm::dvec3 across = p - glm::dot(p, out) * out;
            ASSERT_LT(glm::length(across), reach);
            ASSERT_GT(glm::dot(p, out), 0.0);
            nearest = std::min(nearest, glm::length(across));
        }
        EXPECT_LT(nearest, info.name == "circle" ? 0.011 : 0.003);
    }
}

TEST(StrokeLibrary, WithoutATouchedPointFacesTheViewer) {
    const auto shape = corners(assets::sphere(0.05, 60, 60));
    for (const glm::dvec3& front : {glm::dvec3(0, 0, 1), glm::dvec3(-1, 0, 0), glm::dvec3(0.6, 0.8, 0)}) {
        const StrokePath path = layStroke(shape, {.name = "press", .front = front});
        EXPECT_GT(glm::dot(glm::normalize(path.position(0.0)), front), 0.99);
    }
    // A place where there is no surface is none.
    const StrokePath path =
        laid(shape, "press", StrokePlace{glm::dvec3(0.2, 0.0, 0.0), glm::dvec3(1.0, 0.0, 0.0)});
    EXPECT_GT(glm::normalize(path.position(0.0)).z, 0.99);
}

TEST(StrokeLibrary, DoesWhatItIsTold) {
    const auto shape = corners(assets::plane(0.2, 0.2, 2, 2)); // lies in y = 0
    const StrokePath path =
        layStroke(shape, {.name = "slide", .speed = 0.2, .depth = 0.004, .front = {0, 1, 0}});
    double deepest = 0.0, fastest = 0.0, left = 0.0, right = 0.0;
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        deepest = std::max(deepest, -p.y);
        fastest = std::max(fastest, glm::length(path.velocity(t)));
        left = std::min(left, p.x);
        right = std::max(right, p.x);
    }
    EXPECT_NEAR(deepest, 0.004, 1e-9);
    EXPECT_NEAR(fastest, 0.2, 0.002);
    EXPECT_NEAR(right - left, 0.03, 1e-5);
}

TEST(StrokeLibrary, IsAsSlowAsItIsToldOnTheSurface) {
    const auto shape = corners(assets::plane(0.2, 0.2, 2, 2)); // lies in y = 0
    for (const StrokeInfo& info : strokeInfos()) {
        if (info.name == "edge")
            continue; // there is none
        SCOPED_TRACE(info.name);
        const double speed = info.name == "press" ? 0.001 : 0.01;
        const StrokePath path =
            layStroke(shape, {.name = std::string(info.name), .speed = speed, .front = {0, 1, 0}});
        double inside = 0.0, above = 0.0;
        for (double t = 0.0; t < path.period(); t += kTick) {
            double& fastest = path.position(t).y < 0.0 ? inside : above;
            fastest = std::max(fastest, glm::length(path.velocity(t)));
        }
        EXPECT_GT(inside, 0.6 * speed); // a tap is at its fastest in the air
        EXPECT_LE(inside, speed * (1 + 1e-9));
        EXPECT_LE(above, kLanding * (1 + 1e-9));
    }
}

TEST(StrokeLibrary, HoldsWithTheTremorOfAHand) {
    const auto shape = corners(assets::plane(0.2, 0.2, 2, 2));
    const StrokePath path = layStroke(shape, {.name = "hold", .front = {0, 1, 0}});
    // While it rests on one point: how often it crosses its middle, and by how much.
    int crossings = 0, ticks = 0;
    double square = 0.0, before = 0.0, middle = 0.0;
    const double from = 1.2, to = 3.2; // s, the swell is over
    for (double t = from; t < to; t += kTick, ++ticks)
        middle += path.position(t).x;
    middle /= ticks;
    for (double t = from; t < to; t += kTick) {
        const double x = path.position(t).x - middle;
        crossings += before * x < 0.0;
        square += x * x / ticks;
        before = x;
    }
    EXPECT_GE(crossings / (2.0 * (to - from)), 7.9);
    EXPECT_LE(crossings / (2.0 * (to - from)), 12.0);
    EXPECT_GT(std::sqrt(square), 1e-5);
    EXPECT_LT(std::sqrt(square), 1e-4);
}

TEST(StrokeLibrary, GoesOverTheSharpestEdge) {
    // A wedge of 60 degrees on a block: its ridge, along z at the top, is the sharpest edge.

    const double h = 0.05 * std::sqrt(3.0);
    const std::vector<glm::dvec3> ridge{{0, h, -0.05}, {0, h, 0.05}},
        left{{-0.05, 0, -0.05}, {-0.05, 0, 0.05}}, right{{0.05, 0, -0.05}, {0.05, 0, 0.05}};
    std::vector<glm::dvec3> triangles;
    const auto quad = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                          const glm::dvec3& d) {
        triangles.insert(triangles.end(), {a, b, c, a, c, d});
    };
    quad(ridge[0], left[0], left[1], ridge[1]);
    quad(right[0], ridge[0], ridge[1], right[1]);
    const StrokePath path = laid(triangles, "edge");
    const glm::dvec3 normalLeft = glm::normalize(glm::dvec3(-h, 0.05, 0)),
                     normalRight(-normalLeft.x, normalLeft.y, 0);
    double leftDepth = 0.0, rightDepth = 0.0;
    int crossings = 0;
    double before = 0.0;
    for (double t = 0.0; t < path.period(); t += kTick) {
        const glm::dvec3 p = path.position(t);
        EXPECT_LT(std::abs(p.z), 1e-6) << "it goes across";
        const double inLeft = glm::dot(ridge[0] - p, normalLeft),
                     inRight = glm::dot(ridge[0] - p, normalRight);
        if (inLeft > 0.0 && inRight > 0.0)
            (inLeft < inRight ? leftDepth : rightDepth) =
                std::max(inLeft < inRight ? leftDepth : rightDepth, std::min(inLeft, inRight));
        crossings += before * p.x < 0.0;
        before = p.x;
    }
    EXPECT_NEAR(leftDepth, 0.001, 1e-4);
    EXPECT_NEAR(rightDepth, 0.001, 1e-4);
    EXPECT_GE(crossings, 6);
}

TEST(StrokeLibrary, IsGentleWithSmallModelsAndFindsWhatThereIs) {
    const auto bead = corners(assets::sphere(0.002, 30, 30));
    const std::vector<glm::dvec3> sliver{{0, 0, 0}, {0.1, 0, 0}, {0.05, 0.0004, 0}};
    for (const StrokeInfo& info : strokeInfos()) {
        SCOPED_TRACE(info.name);
        const StrokePath small = laid(bead, std::string(info.name));
        double deepest = 0.0;
        for (double t = 0.0; t < small.period(); t += kTick)
            deepest = std::max(deepest, 0.002 - glm::length(small.position(t)));
        EXPECT_GT(deepest, 1e-4);
        EXPECT_LT(deepest, 8e-4);
        bool through = false;
        const StrokePath thin = laid(sliver, std::string(info.name));
        for (double t = 0.0; t < thin.period(); t += kTick)
            through = through || thin.position(t).z < -0.0005;
        EXPECT_TRUE(through);
    }
}

TEST(StrokeLibrary, SaysWhatIsWrong) {
    const auto shape = corners(assets::sphere(0.05, 20, 20));
    try {
        (void)laid(shape, "caress");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("caress"), std::string::npos);
        for (const StrokeInfo& info : strokeInfos())
            EXPECT_NE(std::string(error.what()).find(info.name), std::string::npos) << info.name;
    }
    EXPECT_EQ(strokeProblem("zigzag"), "");
    EXPECT_THROW((void)layStroke(shape, {.name = "slide", .speed = 2.0}), Error);
    EXPECT_THROW((void)layStroke(shape, {.name = "slide", .speed = NAN}), Error);
    EXPECT_THROW((void)layStroke(shape, {.name = "slide", .depth = -0.001}), Error);
    const std::vector<glm::dvec3> none, point(3, glm::dvec3(0.01)),
        speck{{0, 0, 0}, {1e-26, 0, 0}, {0, 1e-26, 0}}; // two minutes, and no error
    for (const StrokeInfo& info : strokeInfos()) {
        EXPECT_THROW((void)laid(speck, std::string(info.name)), Error) << info.name;
        EXPECT_THROW((void)laid(none, std::string(info.name)), Error) << info.name;
        EXPECT_THROW((void)laid(point, std::string(info.name)), Error) << info.name;
    }
}

} // namespace
} // namespace touchstone
