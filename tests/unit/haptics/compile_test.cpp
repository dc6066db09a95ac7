// Compiling a large scene: what it reports, how it is cancelled, how much memory it takes, what it leaves
// out.

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/mesh/ray_tree.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

namespace touchstone::test::compile_test {
namespace {

/// A torus with everything that an object keeps: 2 * 700 * 350 triangles.
Scene largeScene() {
    Scene scene = sceneOf(assets::torus(0.06, 0.025, 700, 350));
    return scene;
}

struct Reports {
    std::vector<double> fractions;
    std::vector<std::string> whats;
    std::set<std::string> stages;
};

size_t threads() {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                                             std::filesystem::directory_iterator{}));
}

TEST(CompileHapticScene, ReportsAllTheWayInSmallSteps) {
    const Scene scene = largeScene();
    Reports reports;
    const Progress::Report report = [&](double fraction, const char* what) {
        reports.fractions.push_back(fraction);
        reports.whats.emplace_back(what);
        reports.stages.insert(what);
    };
    (void)compileHapticScene(scene, {}, {.rays = true, .progress = Progress(&report, nullptr)});
    ASSERT_GT(reports.fractions.size(), 100u);
    EXPECT_GE(reports.stages.size(), 6u);
    EXPECT_EQ(reports.fractions.back(), 1.0);
    EXPECT_LT(reports.fractions.front(), 0.06);
    for (size_t i = 1; i < reports.fractions.size(); ++i) {
        EXPECT_GE(reports.fractions[i], reports.fractions[i - 1]) << i;
        EXPECT_LT(reports.fractions[i], reports.fractions[i - 1] + 0.06)
            << "from " << reports.fractions[i - 1] << ", however long it takes: " << reports.whats[i];
    }
}

TEST(CompileHapticScene, IsCancelledInsideEveryStageAndLeavesNoThread) {
    const Scene scene = largeScene();
    Reports all;
    const Progress::Report listen = [&](double, const char* what) { all.stages.insert(what); };
    (void)compileHapticScene(scene, {}, {.rays = true, .progress = Progress(&listen, nullptr)});
    const size_t before = threads(); // Embree's own are there by now, and stay
    all.stages.erase("touchable");
    for (const std::string& stage : all.stages) {
        std::atomic<bool> cancel{false};
        std::set<std::string> later;
        const Progress::Report report = [&](double, const char* what) {
            if (cancel)
                later.insert(what);
            else if (what == stage)
                cancel = true;
        };
        EXPECT_THROW(
            (void)compileHapticScene(scene, {}, {.rays = true, .progress = Progress(&report, &cancel)}),
            Cancelled)
            << stage;
        later.erase(stage);
        EXPECT_TRUE(later.empty()) << "after " << stage << " went on with " << *later.begin();
    }
    EXPECT_EQ(threads(), before);
    // And nothing is left in Embree that would spoil the next one.
    EXPECT_TRUE(compileHapticScene(scene, {})->hasRays());
}

TEST(CompileHapticScene, TakesBoundedMemory) {
    const Scene scene = largeScene();
    const auto triangles = static_cast<double>(scene.triangleCount());
    resetPeakBytes();
    const auto haptic = compileHapticScene(scene, {}, {.rays = false, .progress = {}});
    const double peak = static_cast<double>(peakBytes()) / triangles,
                 kept = static_cast<double>(haptic->objects[0]->memoryBytes()) / triangles;
    // 32 of boxes for Embree, 44 of the object's own geometry and attributes; then its tree instead of the
    // boxes.
    EXPECT_LT(peak, 100.0) << "bytes a triangle, without what Embree takes for itself";
    EXPECT_LT(kept, 95.0);
}

TEST(CompileHapticScene, WithoutRaysContactRaysSweepsUntilTheyAreBuilt) {
    HapticSettings settings;
    settings.contact = ContactMethod::Rays;
    settings.proxyRadius = 0.0;
    TouchBench bench(sceneOf(assets::plane(0.1, 0.1)), settings);
    bench.scene = compileHapticScene(sceneOf(assets::plane(0.1, 0.1)), {}, {.rays = false, .progress = {}});
    EXPECT_EQ(bench.scene->objects[0]->rays.get(), nullptr) << "nobody has asked for it yet";
    bench.step({0.001, 0.01, 0.001});
    bench.step({0.001, -0.001, 0.001});
    EXPECT_TRUE(has(bench.output.flags, TickFlag::NeighbourhoodMissing));
    EXPECT_GT(bench.output.contacts, 0u);
    bench.scene->buildRays();
    bench.step({0.001, -0.001, 0.001});
    EXPECT_FALSE(has(bench.output.flags, TickFlag::NeighbourhoodMissing));
    EXPECT_GT(bench.output.contacts, 0u);
}

TEST(CompileHapticScene, ACopyOfAnObjectHasRaysOfItsOwn) {
    const auto scene = compileHapticScene(sceneOf(assets::sphere(0.05, 12, 12)), {});
    const HapticObject copy = *scene->objects[0];
    EXPECT_NE(scene->objects[0]->rays.get(), nullptr);
    EXPECT_EQ(copy.rays.get(), nullptr) << "they would read the vertices of the other";
    const auto other = copyOf(*scene);
    EXPECT_TRUE(other->hasRays());
}

} // namespace
} // namespace touchstone::test::compile_test
