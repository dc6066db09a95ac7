// The committed scene that bends and breathes, and the shared figures, under a hand.
#include "tests/support/shared_files.h"
#include "tests/unit/deforming/deforming_bench.h"

#include <random>

namespace touchstone::test::deforming_touch_test {
namespace {

const std::string kBreathing = std::string(TOUCHSTONE_ASSETS) + "/breathing.glb";

glm::dvec3 placeIn(const DeformingBench& bench, const glm::dvec3& scene) {
    return bench.haptic->workspaceFromScene.point(scene);
}

/// The hand waits beside the stalk, which bends into it and back, twice.
TEST(DeformingTouch, AStalkThatBendsPushesARestingHand) {
    for (const double radius : {0.0, 0.002})
        for (const double friction : {0.0, 0.5}) {
            DeformingBench bench(loadScene(kBreathing), touchedWith(radius, friction));
            const glm::dvec3 hip = placeIn(bench, {-0.068, 0.035, 0.003});
            for (int k = 0; k < 5000; ++k)
                bench.tick(hip, 1e-3 * k);
            EXPECT_GT(bench.report.contacts, 500u);
            EXPECT_EQ(bench.report.jams, 0u);
            EXPECT_EQ(bench.report.starts, 1u) << "touch was lost";
            expectExact(bench.report, "stalk, radius " + std::to_string(1e3 * radius) + " mm, mu " +
                                          std::to_string(friction));
        }
}

TEST(DeformingTouch, ABallThatBreathesCarriesAPressingHand) {
    for (const double radius : {0.0, 0.003}) {
        DeformingBench bench(loadScene(kBreathing), touchedWith(radius, 0.4));
        double least = INFINITY, most = 0.0;
        for (int k = 0; k < 5000; ++k) {
            const double time = 1e-3 * k;
            const double down = std::min(0.03 * time, 0.017); // from above into the ball
            const HapticOutput& output = bench.tick(placeIn(bench, {0.047, 0.018 - down, 0.002}), time);
            if (time > 1.0 && output.contacts > 0) {
                least = std::min(least, glm::length(output.force));
                most = std::max(most, glm::length(output.force));
            }
        }
        EXPECT_GT(most, 1.05 * least) << "the force follows the breath";
        EXPECT_EQ(bench.report.starts, 1u);
        expectExact(bench.report, "ball, radius " + std::to_string(1e3 * radius) + " mm");
    }
}

TEST(DeformingTouch, AHandThatWandersOverEverything) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (const double radius : {0.0, 0.002}) {
        DeformingBench bench(loadScene(kBreathing), touchedWith(radius, 0.3));
        glm::dvec3 hip = placeIn(bench, {0.0, 0.06, 0.0}), to = hip;
        for (int k = 0; k < 12000; ++k) {
            if (k % 200 == 0)
                to = placeIn(bench, {0.09 * unit(random), 0.055 * unit(random), 0.03 * unit(random)});
            hip += 0.02 * (to - hip);
            bench.tick(hip, 1e-3 * k);
        }
        EXPECT_GT(bench.report.contacts, 1000u);
        expectExact(bench.report, "wandering, radius " + std::to_string(1e3 * radius) + " mm");
    }
}

TEST(DeformingTouch, AWalkingFigureFeelsAsItIs) {
    const auto folder = modelsFolder();
    if (!folder)
        GTEST_SKIP() << kNoModels;
    for (const char* name : {"RiggedFigure.glb", "RiggedSimple.glb", "AnimatedMorphCube.glb"}) {
        DeformingBench bench(loadScene(*folder / name), touchedWith(0.001, 0.4));
        bench.closed = false; // the figure's parts run through each other
        std::mt19937 random(3);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        glm::dvec3 hip(0.0, 0.0, 0.09), to = hip;
        for (int k = 0; k < 6000; ++k) {
            if (k % 150 == 0)
                to = 0.08 * glm::dvec3(unit(random), unit(random), unit(random));
            hip += 0.02 * (to - hip);
            bench.tick(hip, 1e-3 * k);
        }
        EXPECT_GT(bench.report.contacts, 50u) << name;
        expectExact(bench.report, name);
    }
}

TEST(DeformingTouch, TwoRunsAreTheSameToTheLastBit) {
    std::vector<uint64_t> hashes;
    for (int run = 0; run < 2; ++run) {
        DeformingBench bench(loadScene(kBreathing), touchedWith(0.001, 0.4));
        Hash64 hash;
        for (int k = 0; k < 3000; ++k) {
            const HapticOutput& output = bench.hand.tick(
                bench.settings, sampleAt(placeIn(bench, {-0.062, 0.03, 0.004})), 1e-3 * k, 1e-3);
            for (const glm::dvec3& v : {output.proxy, output.force})
                for (int c = 0; c < 3; ++c)
                    hash.add(v[c]);
            hash.add(bench.hand.world.poseHash());
        }
        hashes.push_back(hash.value());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

/// With a publisher the vertices are the same; where it was late the ticks say so, and one that stands still
/// there has the same bits.
TEST(DeformingTouch, APublishersTicksAreReplayedToTheLastBit) {
    const ScenePtr source = loadScene(kBreathing);
    const auto haptic = compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace),
                                           {.rays = false, .progress = {}});
    const HapticSettings settings = touchedWith(0.001, 0.4);
    const DeviceSample sample = sampleAt(haptic->workspaceFromScene.point({-0.062, 0.03, 0.004}));
    struct Tick {
        bool held;
        glm::dvec3 proxy;
        uint32_t poses;
    };
    std::vector<Tick> ticks;
    SteppedHand live(*haptic, source);
    live.world.publishAhead(0.0);
    size_t held = 0;
    for (int k = 0; k < 3000; ++k) {
        const HapticOutput& output = live.tick(settings, sample, 1e-3 * k, 1e-3);
        ticks.push_back({has(output.flags, TickFlag::DeformationHeld), output.proxy, live.world.poseHash()});
        held += ticks.back().held ? 1 : 0;
        if (k % 4 == 0)
            std::this_thread::sleep_for(std::chrono::microseconds(200)); // much faster than real time
    }
    std::printf("%zu of %zu ticks were held\n", held, ticks.size());
    EXPECT_LT(held, ticks.size());
    SteppedHand again(*haptic, source);
    for (size_t k = 0; k < ticks.size(); ++k) {
        again.time = 1e-3 * static_cast<double>(k);
        again.world.advance(again.time, ticks[k].held);
        NoStopwatch none;
        const HapticOutput& output = again.step(settings, sample, 1e-3, none);
        ASSERT_EQ(again.world.poseHash(), ticks[k].poses) << k;
        ASSERT_EQ(output.proxy, ticks[k].proxy) << k;
    }
}

TEST(DeformingTouch, ASceneThatDeformsNothingHasNoCopyAndNoThread) {
    const ScenePtr source = loadScene(std::string(TOUCHSTONE_ASSETS) + "/moving.glb");
    const auto haptic = compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace),
                                           {.rays = false, .progress = {}});
    const WorldState world(source, *haptic);
    EXPECT_EQ(&world.touched(*haptic), haptic.get());
    for (const auto& object : haptic->objects)
        EXPECT_EQ(object->instant, nullptr);
}

TEST(DeformingTouch, PlaysAtTheSpeedAndTheTimeOfTheSettings) {
    DeformingBench slow(loadScene(kBreathing), touchedWith(0.0, 0.0)),
        normal(loadScene(kBreathing), touchedWith(0.0, 0.0));
    slow.settings.animationSpeed = 0.25;
    slow.settings.animationOffset = 0.5;
    slow.hand.tick(slow.settings, sampleAt({0, 0.2, 0}), 2.0, 1e-3);
    normal.hand.tick(normal.settings, sampleAt({0, 0.2, 0}), 1.0, 1e-3);
    EXPECT_EQ(slow.hand.world.poseHash(), normal.hand.world.poseHash());
}

} // namespace
} // namespace touchstone::test::deforming_touch_test
