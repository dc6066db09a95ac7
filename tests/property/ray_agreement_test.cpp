// contact=rays against the oracle, in both precisions: how near it comes, how often it rests elsewhere, and
// whether it ever slips through. The same hands as the sweep's exactness.

#include "engine/load/scene_loader.h"
#include "haptics/comparison/ray_path.h"
#include "study/truth/oracle.h"
#include "tests/property/exact_cases.h"
#include "tests/property/hard_shapes.h"
#include "tests/support/shared_files.h"
#include "tests/support/surface_hand.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace touchstone::test {

using namespace truth;

namespace {

/// Lengths in metres of the fitted workspace.
struct RayFigures {
    int ticks = 0, touching = 0, unfinished = 0;
    int apart = 0;              ///< rests farther than kApart from the oracle's
    int lost = 0;               ///< the oracle is held by more than kApart, and here nothing is touched
    std::vector<double> errors; ///< of the ticks that are not apart
    double moves = 0.0;
    [[nodiscard]] double error(double share) {
        if (errors.empty())
            return 0.0;
        std::sort(errors.begin(), errors.end());
        return errors[static_cast<size_t>(share * static_cast<double>(errors.size() - 1))];
    }
};
constexpr double kApart = 5e-6;
constexpr double kFitted = 0.15;

int ticksWanted(int usual) {
    const char* asked = std::getenv("RAY_TICKS");
    return asked != nullptr ? std::atoi(asked) : usual;
}

RayFigures compare(const Scene& scene, Fit fit, Precision precision, double speed, int ticks) {
    HapticSettings s;
    s.contact = ContactMethod::Rays;
    s.precision = precision;
    s.forceShading = ShadingMode::Off;
    s.friction = FrictionMode::Off;
    s.deformation = false;
    s.texture = TextureMode::Off;
    TouchBench bench(scene, s, fit);
    const Soup soup(*bench.scene, 0);
    const Similarity pose = bench.scene->objects[0]->workspaceFromObject;
    double extent = 0.0, smallest = INFINITY;
    for (const auto& object : bench.scene->objects) {
        extent = std::max(extent, object->workspaceFromObject.scale);
        smallest = std::min(smallest, object->workspaceFromObject.scale);
    }
    const double unit = kFitted * pose.scale / extent; // fitted m in one unit of the soup
    SurfaceHand hand(soup, unit, {.speed = speed, .length = 8e-3}, 7);
    // The oracle is a sphere of that radius; each object has a clearance of its own, none less.
    const long double clearance = (precision == Precision::Single ? static_cast<double>(kRayClearance<float>)
                                                                  : kRayClearance<double>)*smallest /
                                  pose.scale;
    const auto proxy = [&] {
        return LVec3(pose.inversePoint(
            bench.scene->objects[static_cast<size_t>(bench.state[0].reference)]->workspaceFromObject.point(
                bench.state[0].proxy)));
    };
    RayFigures figures;
    for (int strokes = 0; strokes < 40 * ticks && figures.ticks < ticks; ++strokes) {
        for (const LVec3& goal : hand.stroke()) {
            const bool placed = bench.state[0].placed;
            const LVec3 before = placed ? proxy() : LVec3(0.0L);
            const HapticOutput& out = bench.step(pose.point(glm::dvec3(goal)));
            if (!bench.state[0].placed)
                break;
            if (!placed)
                continue;
            ++figures.ticks;
            figures.touching += out.contacts > 0 ? 1 : 0;
            figures.moves += out.iterations;
            if (has(out.flags, TickFlag::BudgetReached)) {
                ++figures.unfinished;
                continue;
            }
            const OracleRest rest = oracleRest(soup, before, goal, clearance);
            if (!rest.settled)
                continue;
            const LVec3 now = proxy();
            const double error = unit * static_cast<double>(glm::length(rest.proxy - now));
            const double held = unit * static_cast<double>(glm::length(rest.proxy - goal));
            if (out.contacts == 0 && held > kApart)
                ++figures.lost;
            if (error > kApart)
                ++figures.apart;
            else
                figures.errors.push_back(error);
        }
        bench.state[0].forgetTouch();
    }
    return figures;
}

void report(const std::string& name, Precision precision, RayFigures& f) {
    std::printf("| %s, %s | %d | %d | %.1e | %.1e | %.1e | %d | %d | %d | %.1f |\n", name.c_str(),
                precision == Precision::Single ? "single" : "double", f.ticks, f.touching, f.error(0.5),
                f.error(0.99), f.error(1.0), f.apart, f.lost, f.unfinished,
                f.ticks > 0 ? f.moves / f.ticks : 0.0);
    std::fflush(stdout);
}

void head() {
    std::printf(
        "| scene | ticks | touching | error median, m | p99 | worst | rests elsewhere | lost | out of "
        "moves | moves |\n|---|---|---|---|---|---|---|---|---|---|\n");
}

TEST(RayAgreement, SmoothShapes) {
    head();
    const int ticks = ticksWanted(400);
    for (const auto& [name, shape] :
         {std::pair<std::string, assets::Shape>{"sphere, 1800", assets::sphere(0.05, 30, 30)},
          {"torus, 6480", assets::torus(0.06, 0.025, 72, 45)},
          {"torus, 64,800", assets::torus(0.06, 0.025, 180, 180)}})
        for (const Precision precision : {Precision::Double, Precision::Single})
            for (const double speed : {0.1, 1.0}) {
                RayFigures f = compare(sceneOf(shape), Fit::Workspace, precision, speed, ticks);
                report(name + (speed < 0.5 ? ", 0.1 m/s" : ", 1 m/s"), precision, f);
                EXPECT_GT(f.touching, f.ticks / 4) << name;
                EXPECT_EQ(f.lost, 0) << name;
                EXPECT_LT(f.error(0.99), precision == Precision::Single ? 2e-6 : 1e-6) << name;
                EXPECT_LE(f.apart, f.ticks / 50) << name;
            }
}

TEST(RayAgreement, HardShapes) {
    head();
    const int ticks = ticksWanted(300);
    for (const HardShape& hard : hardShapes())
        for (const Precision precision : {Precision::Double, Precision::Single}) {
            RayFigures f = compare(sceneOf(hard.shape), Fit::Workspace, precision, 0.1, ticks);
            report(hard.name, precision, f);
            EXPECT_GT(f.touching, f.ticks / 8) << hard.name;
        }
}

void compareFiles(const std::filesystem::path& folder) {
    head();
    const int ticks = ticksWanted(150);
    for (const std::filesystem::path& file : gltfFilesIn(folder)) {
        LoadOptions options;
        options.images = {.visual = false, .haptic = false};
        const Scene scene = asMeshes(*loadScene(file, options));
        for (const Precision precision : {Precision::Double, Precision::Single}) {
            RayFigures f = compare(scene, Fit::Workspace, precision, 0.1, ticks);
            report(file.stem().string(), precision, f);
            EXPECT_GT(f.touching, f.ticks / 8) << file;
        }
    }
}

TEST(RayAgreement, SceneFiles) {
    compareFiles(TOUCHSTONE_ASSETS);
}

TEST(RayAgreement, SharedModels) {
    const auto models = modelsFolder();
    if (!models)
        GTEST_SKIP() << kNoModels;
    compareFiles(*models);
}

} // namespace
} // namespace touchstone::test
