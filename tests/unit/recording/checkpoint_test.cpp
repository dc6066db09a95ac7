// A checkpoint is all that touch carries from tick to tick: who goes on from one meets the same bits.

#include "haptics/recording/stage_hashes.h"
#include "haptics/state/touch_checkpoint.h"
#include "haptics/world/world_state.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace touchstone::test {
namespace {

/// One device over a scene, tick by tick, without a servo.
struct Touch {
    const TouchedScene& scene;
    HapticSettings settings;
    WorldState world{scene.source, *scene.haptic};
    DeviceState device{};
    HapticOutput output{};
    double previousTime = std::nan("");

    StageHashes step(const DeviceSample& sample, double time, bool late) {
        TickInput input;
        input.time = time;
        input.late = late;
        input.hands = {&sample, 1};
        world.advance(time);
        StageTrace trace;
        StageTracer tracer(device, trace);
        hapticStep(*scene.haptic, settings, input, world, {&device, 1}, {&output, 1}, tracer);
        previousTime = time;
        return stageHashes(trace, output);
    }
};

struct Case {
    std::string name, file;
    std::vector<std::pair<std::string, std::string>> settings;
    bool fields = false; ///< its objects as distance fields
};

TouchedScene sceneOf(const Case& tested) {
    const TouchedScene scene = touchedScene(tested.file);
    if (!tested.fields)
        return scene;
    return withChanged(scene, [](HapticMaterial& material) { material.implicit = true; });
}

HapticSettings settingsOf(const Case& tested) {
    HapticSettings settings;
    for (const auto& [name, value] : tested.settings)
        EXPECT_EQ(setSetting(settings, name, value), "");
    return settings;
}

class Checkpoints : public testing::TestWithParam<Case> {};

/// A hand that taps, strokes, jumps, rests and is lost, the same for the same seed.
class RestlessHand {
  public:
    explicit RestlessHand(unsigned seed) : random_(seed) {}
    DeviceSample next() {
        const double kind = share_(random_);
        if (kind < 0.01)
            place_ = {0.06 * signedShare(), 0.06 * signedShare(), 0.06 * signedShare()};
        else if (kind < 0.02)
            way_ = 4e-4 * glm::dvec3(signedShare(), signedShare(), signedShare());
        place_ += way_;
        if (glm::length(place_) > 0.09)
            way_ = -1e-4 * place_ / 0.09;
        DeviceSample sample = at(place_);
        sample.valid = share_(random_) > 0.003;
        sample.age = share_(random_) < 0.003 ? 0.05 : 0.0;
        return sample;
    }

  private:
    double signedShare() { return 2.0 * share_(random_) - 1.0; }
    std::mt19937 random_;
    std::uniform_real_distribution<double> share_{0.0, 1.0};
    glm::dvec3 place_{0.0, 0.05, 0.0}, way_{2e-4, -1e-4, 1e-4};
};

TEST_P(Checkpoints, WhoGoesOnFromOneMeetsTheSameBits) {
    const TouchedScene scene = sceneOf(GetParam());
    const HapticSettings settings = settingsOf(GetParam());
    if (settings.contact == ContactMethod::Neighbourhood)
        scene.haptic->buildNeighbourhoods();
    int contacts = 0;
    for (unsigned seed = 0; seed < 4; ++seed) {
        RestlessHand hand(seed);
        Touch original{scene, settings}, resumed{scene, settings};
        for (int tick = 0; tick < 3000; ++tick) {
            if (tick % 25 == 0) {
                TouchCheckpoint checkpoint;
                takeCheckpoint(original.device, checkpoint);
                // In a state that has lived through something else.
                ASSERT_TRUE(restoreCheckpoint(checkpoint.state(), scene.haptic.get(), resumed.device));
                resumed.world.forget();
                if (std::isfinite(original.previousTime))
                    resumed.world.advance(original.previousTime);
            }
            const DeviceSample sample = hand.next();
            const double time = 1e-3 * tick;
            const bool late = tick % 97 == 0;
            const StageHashes expected = original.step(sample, time, late);
            ASSERT_EQ(resumed.step(sample, time, late), expected) << "seed " << seed << ", tick " << tick;
            contacts += original.output.contacts > 0 ? 1 : 0;
        }
    }
    EXPECT_GT(contacts, 500);
}

/// Nothing of a later state survives in an earlier one that is restored over it, no cache either.
TEST_P(Checkpoints, AnEarlierStateIsRestoredOverALaterOne) {
    const TouchedScene scene = sceneOf(GetParam());
    const HapticSettings settings = settingsOf(GetParam());
    if (settings.contact == ContactMethod::Neighbourhood)
        scene.haptic->buildNeighbourhoods();
    constexpr int kTicks = 400;
    for (unsigned seed = 10; seed < 14; ++seed) {
        RestlessHand hand(seed);
        Touch touch{scene, settings};
        struct Lived {
            TouchCheckpoint checkpoint;
            double previousTime;
            DeviceSample sample;
            StageHashes hashes;
        };
        std::vector<Lived> lived(kTicks);
        for (int tick = 0; tick < kTicks; ++tick) {
            Lived& now = lived[static_cast<size_t>(tick)];
            takeCheckpoint(touch.device, now.checkpoint);
            now.previousTime = touch.previousTime;
            now.sample = hand.next();
            now.hashes = touch.step(now.sample, 1e-3 * tick, false);
        }
        for (int tick = kTicks - 1; tick > 0; tick -= 7) {
            const Lived& then = lived[static_cast<size_t>(tick)];
            ASSERT_TRUE(restoreCheckpoint(then.checkpoint.state(), scene.haptic.get(), touch.device));
            touch.world.forget();
            touch.world.advance(then.previousTime);
            ASSERT_EQ(touch.step(then.sample, 1e-3 * tick, false), then.hashes) << seed << ", tick " << tick;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Checkpoints,
    testing::Values(
        Case{"Doughnut", "doughnut.glb", {}},
        Case{"DoughnutWithARadius", "doughnut.glb", {{"proxyRadius", "0.002"}}},
        Case{"Ho",
             "doughnut.glb",
             {{"friction", "ho"}, {"staticFriction", "0.8"}, {"dynamicFriction", "0.5"}}},
        Case{"Elastoplastic", "swatches.glb", {{"friction", "elastoplastic"}, {"staticFriction", "0.5"}}},
        Case{"VelocityThreshold",
             "swatches.glb",
             {{"friction", "velocityThreshold"}, {"staticFriction", "0.5"}, {"texture", "blinnMagnitude"}}},
        Case{"SingleRound", "doughnut.glb", {{"forceShading", "singleRound"}}},
        Case{"Bezier", "doughnut.glb", {{"forceShading", "bezier"}}}, Case{"Swatches", "swatches.glb", {}},
        Case{"Programs", "programs.glb", {}},
        Case{"Surfaces", "surfaces.glb", {{"friction", "ho"}, {"forceShading", "direction"}}},
        Case{"Heights", "heights.glb", {{"proxyRadius", "0.002"}}},
        Case{"Projected", "table1_object4.glb", {{"forceShading", "projected"}}},
        Case{"Direction", "table1_object2.glb", {{"forceShading", "direction"}}},
        Case{"Passivity", "torus_64800.glb", {{"passivity", "control"}, {"stiffness", "3000"}}},
        Case{"Moving", "moving.glb", {}},
        Case{"MovingSticky", "moving.glb", {{"proxyRadius", "0.003"}, {"staticFriction", "2"}}},
        Case{"Neighbourhood", "doughnut.glb", {{"contact", "neighbourhood"}}},
        Case{"Rays", "doughnut.glb", {{"contact", "rays"}}},
        Case{"MovingRaysInSingle",
             "moving.glb",
             {{"contact", "rays"}, {"precision", "single"}, {"staticFriction", "0.7"}}},
        Case{"MovingNeighbourhood", "moving.glb", {{"contact", "neighbourhood"}, {"staticFriction", "0.7"}}},
        Case{"Field", "doughnut.glb", {{"staticFriction", "0.7"}}, true},
        Case{"VirtualPoint",
             "doughnut.glb",
             {{"contact", "virtualPoint"}, {"friction", "kim"}, {"staticFriction", "0.7"}},
             true},
        Case{"Potential", "doughnut.glb", {{"contact", "potential"}}, true}),
    [](const auto& tested) { return tested.param.name; });

/// A field that outlives the tick and is not in the checkpoint would make replays differ here and there: who
/// changes these structures is sent to eachField in touch_checkpoint.cpp and to docs/recording.md.
TEST(TouchCheckpoint, KnowsTheStructuresAsTheyAre) {
    EXPECT_EQ(sizeof(PassivityState), 112u);
    EXPECT_EQ(sizeof(ForceLimiterState), 232u);
    EXPECT_EQ(sizeof(JammedObjects), 232u);
    EXPECT_EQ(sizeof(WatchState), 8u);
    // What a tick writes before it reads, and what can be found again, may be of any size.
    EXPECT_EQ(sizeof(DeviceState) - sizeof(SolveResult) - 2 * sizeof(CandidateCache), 1144u);
    EXPECT_EQ(checkpointSize(), 1045u) << "what is carried belongs to the format";
    EXPECT_LE(checkpointSize(), TouchCheckpoint::kCapacity);
}

TEST(TouchCheckpoint, RefusesWhatIsNoStateOfTheScene) {
    const TouchedScene scene = floorScene(0.0f);
    DeviceState state;
    TouchCheckpoint checkpoint;
    takeCheckpoint(state, checkpoint);
    ASSERT_TRUE(restoreCheckpoint(checkpoint.state(), scene.haptic.get(), state));
    ASSERT_TRUE(restoreCheckpoint(checkpoint.state(), nullptr, state));
    EXPECT_FALSE(restoreCheckpoint(checkpoint.state().first(checkpoint.size - 1), scene.haptic.get(), state));
    // One of before programs ends 81 bytes earlier than one of before dents and grasping: what programs see
    // of the hand begins at nothing.
    state.tool = {.known = true, .time = 3.0};
    state.dents.depth[1] = 0.001;
    state.grasp.object = 0;
    ASSERT_TRUE(
        restoreCheckpoint(checkpoint.state().first(checkpoint.size - 300), scene.haptic.get(), state));
    EXPECT_FALSE(state.dents.any());
    EXPECT_EQ(state.grasp.object, -1);
    ASSERT_TRUE(
        restoreCheckpoint(checkpoint.state().first(checkpoint.size - 381), scene.haptic.get(), state));
    EXPECT_FALSE(state.tool.known);
    EXPECT_EQ(state.tool.time, 0.0);
    state.reference = 1; // there is one object
    takeCheckpoint(state, checkpoint);
    EXPECT_FALSE(restoreCheckpoint(checkpoint.state(), scene.haptic.get(), state));
    state.reference = 0;
    takeCheckpoint(state, checkpoint);
    EXPECT_FALSE(restoreCheckpoint(checkpoint.state(), nullptr, state));
    state.watch = {.side = 4, .touching = true}; // of two triangles
    takeCheckpoint(state, checkpoint);
    EXPECT_FALSE(restoreCheckpoint(checkpoint.state(), scene.haptic.get(), state));
}

TEST(TouchCheckpoint, AnyBytesAreRefusedOrTouchSafely) {
    const TouchedScene scene = touchedScene("moving.glb");
    scene.haptic->buildNeighbourhoods();
    std::mt19937 random(3);
    Touch touch{scene, {}};
    TouchCheckpoint good;
    takeCheckpoint(touch.device, good);
    int taken = 0;
    for (int turn = 0; turn < 3000; ++turn) {
        TouchCheckpoint bad = good;
        const size_t spoilt = 1 + random() % 24;
        for (size_t i = 0; i < spoilt; ++i)
            bad.bytes[random() % bad.size] = static_cast<std::byte>(random());
        if (!restoreCheckpoint(bad.state(), scene.haptic.get(), touch.device))
            continue;
        ++taken;
        touch.settings.contact = random() % 2 == 0 ? ContactMethod::Sweep : ContactMethod::Neighbourhood;
        RestlessHand hand(static_cast<unsigned>(turn));
        for (int tick = 0; tick < 5; ++tick) {
            touch.step(hand.next(), 1e-3 * tick, false);
            const glm::dvec3 force = touch.output.command.force();
            ASSERT_TRUE(glm::length(force) <= DeviceLimits{}.maxForce) << turn;
        }
    }
    EXPECT_GT(taken, 200);
}

TEST(TouchCheckpoint, RefusesPinchedObjectsThatAreNone) {
    const TouchedScene scene = floorScene(0.0f);
    const auto taken = [&](int object, const glm::dvec3& place) {
        DeviceState state;
        EXPECT_TRUE(state.jammed.add(object, place));
        TouchCheckpoint checkpoint;
        takeCheckpoint(state, checkpoint);
        return restoreCheckpoint(checkpoint.state(), scene.haptic.get(), state);
    };
    EXPECT_TRUE(taken(0, {0.0, 0.1, 0.0}));
    EXPECT_FALSE(taken(1, {0.0, 0.1, 0.0}));
    EXPECT_FALSE(taken(-1, {0.0, 0.1, 0.0}));
    EXPECT_FALSE(taken(0, {0.0, 1e16, 0.0}));
    // As many as there is room for, and not one more.
    DeviceState full;
    while (full.jammed.add(0, {0.0, 0.1, 0.0})) {
    }
    ASSERT_EQ(full.jammed.count, JammedObjects::kMax);
    TouchCheckpoint checkpoint;
    takeCheckpoint(full, checkpoint);
    EXPECT_TRUE(restoreCheckpoint(checkpoint.state(), scene.haptic.get(), full));
    full.jammed.count = JammedObjects::kMax + 1;
    takeCheckpoint(full, checkpoint);
    EXPECT_FALSE(restoreCheckpoint(checkpoint.state(), scene.haptic.get(), full));
    EXPECT_FALSE(taken(0, {0.0, std::nan(""), 0.0}));
}

TEST(TouchCheckpoint, RefusesNumbersThatNoTouchComesTo) {
    const TouchedScene scene = floorScene(0.0f);
    const auto taken = [&](const std::function<void(DeviceState&)>& change) {
        DeviceState state;
        change(state);
        TouchCheckpoint checkpoint;
        takeCheckpoint(state, checkpoint);
        return restoreCheckpoint(checkpoint.state(), scene.haptic.get(), state);
    };
    EXPECT_TRUE(taken([](DeviceState&) {}));
    EXPECT_FALSE(taken([](DeviceState& s) { s.gatherMargin = 0.0; }));
    EXPECT_FALSE(taken([](DeviceState& s) { s.gatherMargin = std::nan(""); }));
    for (const double bad : {1e16, -1e16, std::nan("")}) {
        EXPECT_FALSE(taken([&](DeviceState& s) { s.clearance = bad; }));
        EXPECT_FALSE(taken([&](DeviceState& s) { s.hip.x = bad; }));
        EXPECT_FALSE(taken([&](DeviceState& s) { s.proxy.y = bad; }));
        EXPECT_FALSE(taken([&](DeviceState& s) { s.velocity.z = bad; }));
    }
    EXPECT_FALSE(taken([](DeviceState& s) { s.friction = static_cast<FrictionState>(3); }));
    // A shaded facet: of the scene's two triangles, or of a scene before, which nobody asks for.
    const auto shaded = [](int object, uint32_t facet) {
        return [=](DeviceState& s) {
            s.shaded = true;
            s.shadedObject = object;
            s.shadedTriangle = facet;
        };
    };
    EXPECT_TRUE(taken(shaded(0, 1)));
    EXPECT_FALSE(taken(shaded(0, 2)));
    EXPECT_FALSE(taken(shaded(1, 0)));
    EXPECT_TRUE(taken(shaded(-1, 7)));
}

} // namespace
} // namespace touchstone::test
