// Cloth and jelly under a hand: exactness in every tick, force over displacement, return, replay, bad input.
#include "engine/import/volume_file/volume_edits.h"
#include "engine/scene/soft_body.h"
#include "haptics/body/soft_solver.h"
#include "haptics/recording/scene_identity.h"
#include "haptics/scene/scene_parts.h"
#include "haptics/state/touch_checkpoint.h"
#include "tests/support/gltf_maker.h"
#include "tests/unit/deforming/soft_bench.h"

#include <cstring>
#include <random>

namespace touchstone::test::soft_body_test {
namespace {

TEST(SoftBodies, AJellyIsPressedAlongAMonotoneCurveAndComesBack) {
    SoftBench bench(calmJelly(), touchedWith(0.001, 0.0), true);
    const glm::dvec3 above{0.001, kTop + 0.010, 0.0015};
    bench.wait(2.0, above);
    const std::vector<glm::dvec3> rest = bench.vertices();
    double before = -1.0;
    std::printf("HIP below the top at rest, mm: force, N\n");
    for (int step = 0; step <= 12; ++step) {
        const double depth = 1e-3 * step;
        for (int k = 0; k < 100; ++k) // there within 0.1 s
            bench.feel(above + glm::dvec3(0.0, -0.010 - depth + 1e-3 * (1.0 - 0.01 * k), 0.0));
        bench.wait(0.8, above - glm::dvec3(0.0, 0.010 + depth, 0.0));
        double force = 0.0;
        for (int k = 0; k < 200; ++k)
            force += bench.feel(above - glm::dvec3(0.0, 0.010 + depth, 0.0)).force.y / 200.0;
        std::printf("  %5.1f  %.4f\n", 1e3 * depth, force);
        EXPECT_GE(force, before) << depth;
        before = force;
    }
    EXPECT_GT(before, 0.2);
    EXPECT_GT(farthest(bench.vertices(), rest), 1e-3) << "it did not give way";
    bench.wait(3.0, above);
    const double left = farthest(bench.vertices(), rest);
    std::printf("3 s after the hand left: %.4f mm from where it was\n", 1e3 * left);
    EXPECT_LT(left, 1e-4);
    expectExact(bench.report, "jelly, pressed");
}

/// At rest under a hand at rest, with a hand as stiff as a device can be: nothing swings. It was a limit
/// cycle of 1 to 4 mm where the hand's force, or its place, was that of another state than the one it met.
TEST(SoftBodies, AHandAtRestFindsAJellyAtRest) {
    for (const double stiffness : {300.0, 600.0, 3000.0}) {
        HapticSettings settings = touchedWith(0.001, 0.0);
        settings.stiffness = stiffness;
        SoftBench bench(calmJelly(), settings, true);
        double widest = 0.0;
        for (const double depth : {0.001, 0.002, 0.004, 0.008}) {
            const glm::dvec3 hip{0.001, kTop - depth, 0.0015};
            for (int k = 0; k < 300; ++k) // from above, in 0.3 s
                bench.feel(hip + glm::dvec3(0.0, (depth + 0.002) * (1.0 - k / 300.0), 0.0));
            bench.wait(1.2, hip);
            double least = INFINITY, most = 0.0;
            for (int k = 0; k < 200; ++k) {
                const double force = bench.feel(hip).force.y;
                least = std::min(least, force);
                most = std::max(most, force);
            }
            EXPECT_GT(least, 0.0);
            widest = std::max(widest, (most - least) / stiffness);
        }
        std::printf("%.0f N/m: the surface moves by %.2g mm under a hand at rest\n", stiffness, 1e3 * widest);
        EXPECT_LT(widest, 1e-6);
    }
}

/// It costs nothing while nothing happens, and wakes at a touch, or with another gravity.
TEST(SoftBodies, ABodyAtRestSleepsUntilItIsTouched) {
    SoftBench bench(calmJelly(), touchedWith(0.001, 0.0), true);
    const glm::dvec3 away{0.003, kTop + 0.03, 0.002};
    bench.wait(0.3, away);
    EXPECT_FALSE(bench.hand.world.still()) << "it sags";
    bench.wait(4.0, away);
    EXPECT_TRUE(bench.hand.world.still());
    const std::vector<glm::dvec3> asleep = bench.vertices();
    bench.wait(0.2, away);
    EXPECT_EQ(bench.vertices(), asleep);
    for (int k = 0; k < 200; ++k) // down to 4 mm below its top, in 0.2 s
        bench.feel(away - glm::dvec3(0.0, 0.034 * k / 200.0, 0.0));
    bench.wait(0.2, {0.003, kTop - 0.004, 0.002});
    EXPECT_FALSE(bench.hand.world.still());
    EXPECT_GT(farthest(bench.vertices(), asleep), 1e-3);
    bench.wait(4.0, away);
    EXPECT_TRUE(bench.hand.world.still());
    EXPECT_LT(farthest(bench.vertices(), asleep), 2e-5);
    bench.settings.gravity = 0.0;
    bench.wait(1.0, away);
    EXPECT_GT(farthest(bench.vertices(), asleep), 1e-4) << "it hangs no more";
    expectExact(bench.report, "jelly, asleep");
}

TEST(SoftBodies, AJellyKeepsItsVolumeAndBreathes) {
    SoftBench bench(kJelly, touchedWith(0.001, 0.0), true);
    const auto volume = [&] {
        const size_t k = bench.hand.world.soft()->shown()[0].object;
        const auto& indices = bench.haptic->objects[k]->indices;
        const std::vector<glm::dvec3> at = bench.vertices();
        double sum = 0.0;
        for (size_t i = 0; i + 2 < indices.size(); i += 3)
            sum += glm::dot(at[indices[i]], glm::cross(at[indices[i + 1]], at[indices[i + 2]])) / 6.0;
        return sum;
    };
    bench.feel({0.0, 0.2, 0.0});
    const double rest = volume();
    double least = INFINITY, most = 0.0;
    for (int k = 0; k < 8000; ++k) {
        bench.feel({0.0, 0.2, 0.0});
        least = std::min(least, volume() / rest);
        most = std::max(most, volume() / rest);
    }
    std::printf("volume over that at rest: %.4f .. %.4f\n", least, most);
    EXPECT_GT(most - least, 0.01) << "it does not breathe";
    EXPECT_GT(least, 0.9);
    EXPECT_LT(most, 1.1);
}

TEST(SoftBodies, AHandWandersOverABreathingJelly) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (const double friction : {0.0, 0.4}) {
        SoftBench bench(kJelly, touchedWith(0.001, friction), true);
        glm::dvec3 hip{0.0, kTop + 0.02, 0.0}, to = hip;
        for (int k = 0; k < 8000; ++k) {
            if (k % 150 == 0)
                to = {0.05 * unit(random), 0.01 + 0.035 * unit(random), 0.05 * unit(random)};
            hip += 0.02 * (to - hip);
            bench.feel(hip);
        }
        EXPECT_GT(bench.report.contacts, 500u);
        expectExact(bench.report, "jelly, wandering, mu " + std::to_string(friction));
    }
}

TEST(SoftBodies, AClothLiesOverTheBallAndIsFelt) {
    SoftBench bench(kCloth, touchedWith(0.001, 0.3), false);
    bench.wait(3.0, {0.0, 0.05, 0.0});
    const glm::dvec3 centre = bench.haptic->workspaceFromScene.point({0.0, -0.012, 0.0});
    const double scale = bench.haptic->workspaceFromScene.scale;
    double nearest = INFINITY, lowest = INFINITY;
    for (const glm::dvec3& v : bench.vertices()) {
        nearest = std::min(nearest, glm::distance(v, centre) / scale);
        lowest = std::min(lowest, (v.y - centre.y) / scale);
    }
    std::printf("nearest vertex %.2f mm from the ball's centre (radius 30), lowest %.2f mm below it\n",
                1e3 * nearest, -1e3 * lowest);
    EXPECT_GT(nearest, 0.0295) << "the cloth is in the ball";
    EXPECT_LT(lowest, 0.01) << "the cloth does not hang";
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    glm::dvec3 hip{0.0, 0.05, 0.0}, to = hip;
    for (int k = 0; k < 8000; ++k) {
        if (k % 200 == 0)
            to = {0.04 * unit(random), 0.005 + 0.025 * unit(random), 0.04 * unit(random)};
        hip += 0.02 * (to - hip);
        bench.feel(hip);
    }
    EXPECT_GT(bench.report.contacts, 300u);
    expectExact(bench.report, "cloth, wandering");
}

/// A hand that pushes, with the bodies' state in the middle given to another world, which then does the same.
TEST(SoftBodies, StatesGoOnToTheLastBit) {
    for (const std::string& path : {kJelly, kCloth}) {
        SoftBench bench(path, touchedWith(0.001, 0.3), false);
        const auto hipAt = [](size_t k) {
            return glm::dvec3{0.004 * std::sin(0.01 * static_cast<double>(k)),
                              0.03 - 1e-5 * static_cast<double>(k % 1700), 0.002};
        };
        std::vector<std::byte> kept;
        std::vector<uint32_t> hashes;
        for (size_t k = 0; k < 3000; ++k) {
            if (k == 1501)
                kept = bench.hand.world.bodyState();
            bench.feel(hipAt(k));
            hashes.push_back(bench.hand.world.poseHash());
        }
        SoftBench again(path, touchedWith(0.001, 0.3), false);
        again.wait(0.3, {0.0, 0.02, 0.0}); // another past
        again.hand.state = bench.hand.state;
        ASSERT_TRUE(again.hand.world.restoreBodies(kept));
        // Without the hand's own state only the first tick of a body that nothing touches is the same.
        again.hand.tick(again.settings, sampleAt({0.0, 0.3, 0.0}), 1.501, 1e-3);
        EXPECT_EQ(again.hand.world.poseHash(), hashes[1501]);
        kept.pop_back();
        EXPECT_FALSE(again.hand.world.restoreBodies(kept));
    }
}

/// A replay may begin anywhere, with a solver that has stepped nothing yet. Bullet took the lengths of the
/// edges at rest from the first state that it stepped: a replay of an edit differed.
TEST(SoftBodies, AStepDependsOnItsArgumentsAlone) {
    for (const SoftKind kind : {SoftKind::Cloth, SoftKind::Jelly}) {
        body::SoftShape shape;
        for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            shape.vertices.emplace_back(0.02 * x, 0.02 * y, -0.02);
        for (size_t v = 0; v < 4; ++v)
            shape.vertices.push_back(shape.vertices[v] + glm::dvec3(0, 0, 0.04));
        shape.triangles = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                           1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
        shape.fixed.assign(8, 0);
        shape.fixed[0] = 1;
        SoftBody law;
        law.kind = kind;
        law.shapeFrequency = kind == SoftKind::Jelly ? 25.0 : 0.0;
        law.volumeStiffness = kind == SoftKind::Jelly ? 8000.0 : 0.0;
        body::SoftSolver old(law, shape, 1.0);
        body::SoftState now = old.rest(), next = now;
        for (uint64_t k = 0; k < 40; ++k) { // it falls and hangs
            old.step(now, now, now, {}, 9.81, k, next);
            std::swap(now, next);
        }
        body::SoftSolver fresh(law, shape, 1.0);
        body::SoftState again = next;
        old.step(now, now, now, {}, 9.81, 40, next);
        fresh.step(now, now, now, {}, 9.81, 40, again);
        EXPECT_EQ(again, next);
        EXPECT_NE(next, now);
    }
}

/// A scene of equal geometry, as after an edit of a material, takes the bodies over in the middle of a press.
TEST(SoftBodies, AnEditLeavesThemWhereTheyAre) {
    for (const std::string& path : {kJelly, kCloth}) {
        const HapticSettings settings = touchedWith(0.001, 0.3);
        SoftBench bench(path, settings, path == kJelly), whole(path, settings, path == kJelly);
        const double top = path == kJelly ? kTop : 0.020;
        const auto hipAt = [&](int k) {
            return glm::dvec3{0.001, top + 0.01 - 1.5e-5 * std::min(k, 900), 0.0015};
        };
        for (int k = 0; k < 1200; ++k) {
            if (k > 0 && k % 97 == 0) { // as ServoLoop::adopt
                auto edited = copyOf(*bench.haptic);
                bench.hand.world = WorldState(bench.source, *edited, WorldBodies::Simulated,
                                              {.soft = bench.hand.world.soft()});
                bench.hand.world.advance(1e-3 * (k - 1));
                bench.hand.state.candidates.invalidate(); // they point into the scene before
                whole.hand.state.candidates.invalidate();
                bench.hand.scene = edited.get();
                bench.haptic = std::move(edited);
            }
            bench.feel(hipAt(k));
            whole.feel(hipAt(k));
            ASSERT_EQ(bench.hand.world.poseHash(), whole.hand.world.poseHash()) << k;
            ASSERT_EQ(bench.hand.output.proxy, whole.hand.output.proxy) << k;
            ASSERT_EQ(bench.hand.output.force, whole.hand.output.force) << k;
        }
        EXPECT_EQ(bench.report.starts, 1u);
        EXPECT_GT(bench.report.contacts, 200u);
        expectExact(bench.report, "edited, " + path.substr(path.rfind('/') + 1));
    }
}

/// Of another scene, or of a part without one of them.
TEST(SoftBodies, OtherBodiesBeginAnew) {
    const ScenePtr jelly = loadScene(kJelly), again = loadScene(kJelly);
    const auto haptic = compileHapticScene(*jelly, Similarity{}),
               other = compileHapticScene(*again, Similarity{});
    const WorldState world(jelly, *haptic);
    EXPECT_TRUE(softGoOn(world.soft().get(), jelly.get(), *haptic));
    EXPECT_FALSE(softGoOn(world.soft().get(), again.get(), *other)) << "read again: its law may be another";
    EXPECT_FALSE(softGoOn(nullptr, jelly.get(), *haptic));
    const CarriedOver goesOn{.soft = world.soft()};
    EXPECT_EQ(WorldState(jelly, *haptic, WorldBodies::Simulated, goesOn).soft(), world.soft());
    const WorldState anew(again, *other, WorldBodies::Simulated, goesOn);
    EXPECT_NE(anew.soft(), world.soft());
    EXPECT_NE(anew.soft(), nullptr);
    ScenePart part;
    part.clip = ClipPlane{.normal = {1, 0, 0}, .offset = 0.001};
    EXPECT_FALSE(softGoOn(world.soft().get(), jelly.get(), *partOf(*haptic, *jelly, part)));
}

TEST(SoftBodies, ADamagedStateIsRefusedAndChangesNothing) {
    const HapticSettings settings = touchedWith(0.001, 0.3);
    const auto press = [](SoftBench& bench) {
        for (int k = 0; k < 600; ++k)
            bench.feel({0.001, kTop + 0.01 - 2.5e-5 * k, 0.0015});
    };
    SoftBench bench(kJelly, settings, false), whole(kJelly, settings, false);
    press(bench);
    press(whole);
    const std::vector<std::byte> kept = bench.hand.world.bodyState();
    // The fraction, and with it the count of pushes, wherever that stands.
    const double bad = -1.0;
    for (size_t at = 32; at + 8 <= std::min<size_t>(kept.size(), 16384); at += 8) {
        std::vector<std::byte> damaged = kept;
        const uint64_t many = uint64_t{1} << 40;
        std::memcpy(damaged.data() + 8, &bad, sizeof bad);
        std::memcpy(damaged.data() + at, &many, sizeof many);
        ASSERT_FALSE(bench.hand.world.restoreBodies(damaged)) << at;
        ASSERT_TRUE(bench.hand.world.bodyState() == kept) << at << ": what is refused changes nothing";
    }
    for (int k = 0; k < 50; ++k) {
        bench.feel({0.001, kTop - 0.005, 0.0015});
        whole.feel({0.001, kTop - 0.005, 0.0015});
        ASSERT_EQ(bench.hand.world.poseHash(), whole.hand.world.poseHash()) << k;
    }
}

/// Of --loose: no scene has both kinds of bodies.
TEST(SoftBodies, AreNotMadeLoose) {
    LoadOptions options;
    options.edits = withLoose({});
    for (const std::string& path : {kJelly, kCloth}) {
        const ScenePtr scene = loadScene(path, options);
        EXPECT_EQ(scene->physics, nullptr) << path;
        EXPECT_TRUE(std::ranges::any_of(scene->warnings, [](const Warning& warning) {
            return warning.message.find("not made loose") != std::string::npos;
        })) << path;
    }
}

/// With all of the effects, and from checkpoints on, as a recording has them.
TEST(SoftBodies, AThreadsTicksAreReplayedToTheLastBit) {
    const ScenePtr source = loadScene(kJelly);
    const auto haptic = compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace),
                                           {.rays = false, .progress = {}});
    HapticSettings settings = touchedWith(0.001, 0.3);
    settings.forceShading = HapticSettings{}.forceShading;
    const auto sampleOf = [&](size_t k) { // from above, so that the hand is not in the jelly when it begins
        const double t = 1e-3 * static_cast<double>(k);
        return k < 20 ? sampleAt({0.0, 0.2, 0.0})
                      : sampleAt(haptic->workspaceFromScene.point(
                            {0.02 * std::sin(5.0 * t), kTop - 0.008, 0.02 * std::cos(3.0 * t)}));
    };
    struct Tick {
        bool held;
        glm::dvec3 proxy, force;
        uint32_t poses;
        std::vector<std::byte> bodies;
        TouchCheckpoint hand;
    };
    std::vector<Tick> ticks(3000);
    SteppedHand live(*haptic, source);
    live.world.publishAhead(0.0);
    size_t held = 0;
    for (size_t k = 0; k < ticks.size(); ++k) {
        Tick& tick = ticks[k];
        if (k % 100 == 50) {
            tick.bodies = live.world.bodyState();
            takeCheckpoint(live.state, tick.hand);
        }
        const HapticOutput& output = live.tick(settings, sampleOf(k), 1e-3 * static_cast<double>(k), 1e-3);
        tick.held = has(output.flags, TickFlag::DeformationHeld);
        tick.proxy = output.proxy;
        tick.force = output.force;
        tick.poses = live.world.poseHash();
        held += tick.held ? 1 : 0;
        if (k % 4 == 0)
            std::this_thread::sleep_for(std::chrono::microseconds(300)); // faster than real time
    }
    std::printf("%zu of %zu ticks were held\n", held, ticks.size());
    EXPECT_LT(held, ticks.size());
    SteppedHand again(*haptic, source);
    for (size_t k = 0; k < ticks.size(); ++k) {
        if (!ticks[k].bodies.empty()) {
            ASSERT_TRUE(restoreCheckpoint(ticks[k].hand.state(), haptic.get(), again.state)) << k;
            ASSERT_TRUE(again.world.restoreBodies(ticks[k].bodies)) << k;
        }
        again.time = 1e-3 * static_cast<double>(k);
        again.world.advance(again.time, ticks[k].held);
        NoStopwatch none;
        const HapticOutput& output = again.step(settings, sampleOf(k), 1e-3, none);
        ASSERT_EQ(again.world.poseHash(), ticks[k].poses) << k;
        ASSERT_EQ(output.proxy, ticks[k].proxy) << k;
        ASSERT_EQ(output.force, ticks[k].force) << k;
    }
}

/// What is wrong says so and stays hard.
TEST(SoftBodies, WhatCannotBeSoftStaysHardWithAMessage) {
    struct Case {
        const char* message;
        nlohmann::json stated;
    };
    const std::vector<Case> cases{
        {"kind", {{"mass", 0.1}}},
        {"kind", {{"kind", "stone"}}},
        {"mass", {{"kind", "cloth"}, {"mass", 0.0}}},
        {"mass", {{"kind", "cloth"}, {"mass", -1.0}}},
        {"mass", {{"kind", "cloth"}, {"mass", 1e30}}},
        {"mass", {{"kind", "cloth"}, {"mass", "heavy"}}},
        {"stretch", {{"kind", "cloth"}, {"stretch", 1e30}}},
        {"volumeStiffness", {{"kind", "jelly"}, {"volumeStiffness", 1e38}}},
        {"cloth", {{"kind", "cloth"}, {"shapeFrequency", 5.0}}},
        {"over", {{"kind", "cloth"}, {"over", {99}}}},
        {"over", {{"kind", "cloth"}, {"over", {-1}}}},
        {"over", {{"kind", "cloth"}, {"over", {0}}}},
        {"fixed", {{"kind", "cloth"}, {"fixed", {{"min", {0.0, 0.0}}}}}},
    };
    for (const Case& wrong : cases) {
        GltfMaker maker = GltfMaker::square();
        maker.json["nodes"][0]["extensions"]["TOUCHSTONE_soft_body"] = wrong.stated;
        maker.json["extensionsUsed"] = {"TOUCHSTONE_soft_body"};
        const ScenePtr scene = loadSceneFromMemory(maker.glb(), {});
        const bool told = std::ranges::any_of(scene->warnings, [&](const Warning& warning) {
            return (warning.place + warning.message).find(wrong.message) != std::string::npos &&
                   warning.message.find("stays hard") != std::string::npos;
        });
        EXPECT_TRUE(told) << wrong.stated;
        for (const Mesh& mesh : scene->meshes)
            EXPECT_EQ(mesh.deformation, nullptr) << wrong.stated;
    }
}

/// A sheet of `side` x `side` vertices, `flat`: all in one line.
GltfMaker sheetOf(uint32_t side, bool flat) {
    GltfMaker maker = GltfMaker::square();
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < side; ++i)
        for (uint32_t j = 0; j < side; ++j) {
            const float x = static_cast<float>(i) / static_cast<float>(side - 1);
            positions.insert(positions.end(),
                             {x, flat ? 0.0f : static_cast<float>(j) / static_cast<float>(side - 1), 0.0f});
            if (i > 0 && j > 0) {
                const uint32_t a = (i - 1) * side + j - 1, b = a + side;
                indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        }
    const size_t accessor = maker.addAccessor<float>(positions, "VEC3");
    maker.json["accessors"][accessor]["min"] = {0.0, 0.0, 0.0};
    maker.json["accessors"][accessor]["max"] = {1.0, flat ? 0.0 : 1.0, 0.0};
    maker.json["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", accessor}}},
                                                {"indices", maker.addAccessor<uint32_t>(indices, "SCALAR")}};
    maker.json["nodes"][0]["extensions"]["TOUCHSTONE_soft_body"] = {{"kind", "cloth"}};
    maker.json["extensionsUsed"] = {"TOUCHSTONE_soft_body"};
    return maker;
}

TEST(SoftBodies, MeshesThatCannotBeSoftStayHardWithAMessage) {
    for (const uint32_t side : {4u, 65u, 317u}) { // no area; 4,225 and 10^5 vertices
        const bool flat = side == 4;
        const ScenePtr scene = loadSceneFromMemory(sheetOf(side, flat).glb(), {});
        EXPECT_TRUE(std::ranges::any_of(scene->warnings, [&](const Warning& warning) {
            return warning.message.find(flat ? "no area" : "at most 4096") != std::string::npos;
        })) << flat;
        for (const Mesh& mesh : scene->meshes)
            EXPECT_EQ(mesh.deformation, nullptr);
    }
}

TEST(SoftBodies, ASceneHasEightOfThem) {
    GltfMaker maker = sheetOf(4, false);
    for (size_t n = 1; n < 12; ++n) {
        maker.json["nodes"].push_back(maker.json["nodes"][0]);
        maker.json["scenes"][0]["nodes"].push_back(n);
    }
    const ScenePtr scene = loadSceneFromMemory(maker.glb(), {});
    EXPECT_EQ(
        std::ranges::count_if(scene->meshes, [](const Mesh& mesh) { return mesh.deformation != nullptr; }),
        8);
    EXPECT_TRUE(std::ranges::any_of(scene->warnings, [](const Warning& warning) {
        return warning.message.find("beyond the 8 soft meshes") != std::string::npos;
    }));
}

/// The hull of what is flat is an endless slab.
TEST(SoftBodies, WhatIsFlatCannotBeLainOn) {
    GltfMaker maker = sheetOf(4, false);
    nlohmann::json below = maker.json["nodes"][0];
    below.erase("extensions");
    maker.json["nodes"].push_back(below);
    maker.json["scenes"][0]["nodes"].push_back(1);
    maker.json["nodes"][0]["extensions"]["TOUCHSTONE_soft_body"]["over"] = {1};
    const ScenePtr scene = loadSceneFromMemory(maker.glb(), {});
    EXPECT_TRUE(std::ranges::any_of(scene->warnings, [](const Warning& warning) {
        return warning.message.find("flat mesh") != std::string::npos;
    }));
    for (const Mesh& mesh : scene->meshes)
        EXPECT_EQ(mesh.deformation, nullptr);
}

/// The vertices of a part are other ones than those of the mesh.
TEST(SoftBodies, AJellyThatAPlaneCutsStaysAsItIs) {
    const ScenePtr scene = loadScene(kJelly);
    const auto whole = compileHapticScene(*scene, Similarity{});
    EXPECT_NE(SoftObjects::of(scene, *whole), nullptr);
    ScenePart part;
    part.clip = ClipPlane{.normal = {1, 0, 0}, .offset = 0.001};
    const auto cut = partOf(*whole, *scene, part);
    EXPECT_TRUE(cut->objects[0]->cut);
    EXPECT_EQ(SoftObjects::of(scene, *cut), nullptr);
}

/// A cube of 40 mm whose triangles face inwards.
TEST(SoftBodies, AJellyTurnedInsideOutKeepsItsVolume) {
    const std::vector<uint32_t> outwards{0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                         1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    std::array<double, 2> ratios{};
    for (const bool inward : {false, true}) {
        body::SoftShape shape;
        for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            shape.vertices.emplace_back(0.02 * x, 0.02 * y, -0.02);
        for (size_t v = 0; v < 4; ++v)
            shape.vertices.push_back(shape.vertices[v] + glm::dvec3(0, 0, 0.04));
        shape.triangles = outwards;
        for (size_t i = 0; inward && i + 2 < outwards.size(); i += 3)
            std::swap(shape.triangles[i + 1], shape.triangles[i + 2]);
        shape.fixed.assign(8, 0);
        SoftBody law;
        law.shapeFrequency = 25.0;
        law.volumeStiffness = 8000.0;
        law.damping = 60.0;
        law.breath = 0.1;
        body::SoftSolver solver(law, shape, 1.0);
        body::SoftState now = solver.rest(), next = now;
        for (uint64_t k = 0; k < 250; ++k) { // a quarter of a breath: at its largest
            solver.step(now, now, now, {}, 0.0, k, next);
            std::swap(now, next);
        }
        ratios[inward ? 1 : 0] = solver.volumeOf(now) / solver.volumeOf(solver.rest());
    }
    EXPECT_NEAR(ratios[1], ratios[0], 1e-3) << "whichever way its triangles face";
    EXPECT_GT(ratios[1], 1.0) << "it swells";
    EXPECT_LT(ratios[1], 1.15);
}

TEST(SoftBodies, ARecordingKnowsItsLaw) {
    const ScenePtr scene = loadScene(kJelly);
    const auto haptic = compileHapticScene(*scene, Similarity{});
    EXPECT_NE(feltHash(*haptic, *scene), feltHash(*haptic, *calmJelly())) << "one breathes";
}

/// A hand with all stiffnesses at their ends: the limits hold, and nothing is lost for ever.
TEST(SoftBodies, TheHardestNumbersKeepTheLimits) {
    for (const nlohmann::json& hard : std::vector<nlohmann::json>{
             {{"kind", "jelly"},
              {"mass", 1e-4},
              {"volumeStiffness", 1e6},
              {"shapeFrequency", 100.0},
              {"damping", 0.0}},
             {{"kind", "cloth"}, {"mass", 1000.0}, {"stretch", 1.0}, {"damping", 0.0}},
             {{"kind", "cloth"},
              {"mass", 1e-4},
              {"stretch", 1.0},
              {"touchRadius", 1e-4},
              {"damping", 0.0}}}) {
        GltfMaker maker = sheetOf(12, false);
        maker.json["nodes"][0]["extensions"]["TOUCHSTONE_soft_body"] = hard;
        SoftBench bench(loadSceneFromMemory(maker.glb(), {}), touchedWith(0.001, 0.3), false);
        ASSERT_NE(bench.hand.world.soft(), nullptr);
        std::mt19937 random(2);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        glm::dvec3 hip{0.5, 0.5, 0.3}, to = hip;
        for (int k = 0; k < 4000; ++k) {
            if (k % 100 == 0)
                to = {0.5 + 0.5 * unit(random), 0.5 + 0.5 * unit(random), 0.3 * unit(random)};
            hip += 0.03 * (to - hip);
            bench.feel(hip);
        }
        EXPECT_LT(bench.report.deepest, 2e-12L) << hard;
        EXPECT_LE(bench.report.overLimit, 1e-9) << hard;
    }
}

TEST(SoftBodies, ASceneWithoutThemMakesNone) {
    for (const char* name : {"/moving.glb", "/breathing.glb", "/box.glb"}) {
        const ScenePtr source = loadScene(std::string(TOUCHSTONE_ASSETS) + name);
        const auto haptic = compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace),
                                               {.rays = false, .progress = {}});
        const WorldState world(source, *haptic);
        EXPECT_EQ(world.soft(), nullptr) << name;
    }
}

} // namespace
} // namespace touchstone::test::soft_body_test
