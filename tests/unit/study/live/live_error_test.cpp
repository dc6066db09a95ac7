// What the panel says about accuracy: none where the configurations are the reference's, the known one where
// one is put in, some where a configuration is cheaper.

#include "devices/stroke/stroke_path.h"
#include "haptics/tick/stepped_hand.h"
#include "study/live/live_error.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace touchstone::study {
namespace {

using test::TouchedScene;

constexpr double kRate = 1000.0;

HapticSettings settingsWith(const std::vector<std::pair<std::string, std::string>>& values) {
    HapticSettings settings;
    for (const auto& [name, value] : values)
        EXPECT_EQ(setSetting(settings, name, value), "");
    return settings;
}

/// The reference's own configurations: the defaults but for the texture filter.
const HapticSettings kExact = settingsWith({{"textureFilter", "bicubic"}});

/// What a servo would have recorded of a simulated hand that strokes the scene.
std::vector<TickRecord> lived(const TouchedScene& scene, const HapticSettings& settings, size_t ticks) {
    if (settings.contact == ContactMethod::Neighbourhood)
        scene.haptic->buildNeighbourhoods();
    const StrokePath path = strokeOver(*scene.source, scene.haptic->workspaceFromScene);
    SteppedHand hand(*scene.haptic, scene.source);
    std::vector<TickRecord> records(ticks);
    for (size_t i = 0; i < ticks; ++i) {
        TickRecord& record = records[i];
        record.tick = record.step = i;
        record.time = static_cast<double>(i) / kRate;
        record.dt = 1.0 / kRate;
        record.scene = 1;
        record.sample = test::at(path.position(record.time));
        hand.advance(record.time);
        StageTracer tracer(hand.state, record.trace);
        record.output = hand.step(settings, record.sample, record.dt, tracer);
    }
    return records;
}

/// The reference beside these records, over all of them.
LiveErrorFigures compared(const TouchedScene& scene, const std::vector<TickRecord>& records,
                          const HapticSettings& settings) {
    LiveError error(kRate, static_cast<double>(records.size()) / kRate, records.size());
    error.sceneOffered(1, scene.haptic, scene.source);
    for (const TickRecord& record : records)
        error.take(record, settings);
    error.drain();
    return error.figures();
}

LiveErrorFigures figuresOf(const std::string& file, const HapticSettings& settings, size_t ticks = 3000) {
    const TouchedScene scene = test::touchedScene(file);
    return compared(scene, lived(scene, settings, ticks), settings);
}

TEST(LiveError, IsNoneToTheLastBitWhereTheRungsAreTheReferences) {
    for (const char* file : {"doughnut.glb", "box.glb", "moving.glb"}) {
        const LiveErrorFigures figures = figuresOf(file, kExact);
        EXPECT_GT(figures.inContact, 900u) << file;
        EXPECT_EQ(figures.position.p99, 0.0) << file;
        EXPECT_EQ(figures.force.p99, 0.0) << file;
        EXPECT_EQ(figures.direction.p99, 0.0) << file;
        EXPECT_EQ(figures.lost + figures.invented, 0u) << file;
        EXPECT_EQ(figures.dropped, 0u);
        EXPECT_EQ(figures.compared, 2999u) << "all but the one that it begins with";
        EXPECT_GT(figures.comparedShare, 0.999);
    }
}

/// Their vertices are where all ticks before put them, which the reference does not have.
TEST(LiveError, SoftBodiesAreNotCompared) {
    const LiveErrorFigures figures = figuresOf("jelly.glb", kExact, 1500);
    EXPECT_EQ(figures.compared, 0u);
    EXPECT_EQ(figures.comparedShare, 0.0);
}

TEST(LiveError, TellsAnErrorThatWasPutIn) {
    const TouchedScene scene = test::touchedScene("doughnut.glb");
    std::vector<TickRecord> records = lived(scene, kExact, 2000);
    constexpr double kShift = 7e-6, kStronger = 1.25, kTurn = 0.02;
    for (TickRecord& record : records) {
        HapticOutput& felt = record.output;
        if (felt.contacts == 0)
            continue;
        felt.proxy.x += kShift;
        const glm::dvec3 side = glm::normalize(glm::cross(felt.force, glm::dvec3(1.0, 0.3, 0.2)));
        felt.force =
            kStronger * (std::cos(kTurn) * felt.force + std::sin(kTurn) * glm::length(felt.force) * side);
    }
    const LiveErrorFigures figures = compared(scene, records, kExact);
    for (const double position : {figures.position.p50, figures.position.p99})
        EXPECT_NEAR(position, kShift, 1e-12);
    for (const double share : {figures.forceShare.p50, figures.forceShare.p99})
        EXPECT_NEAR(share, kStronger - 1.0, 1e-9);
    for (const double direction : {figures.direction.p50, figures.direction.p99})
        EXPECT_NEAR(direction, kTurn, 1e-9);
}

TEST(LiveError, TellsContactThatIsMissing) {
    const TouchedScene scene = test::touchedScene("doughnut.glb");
    std::vector<TickRecord> records = lived(scene, kExact, 2000);
    uint64_t taken = 0;
    for (size_t i = 1500; i < 1600; ++i)
        if (records[i].output.contacts > 0) {
            records[i].output = HapticOutput{};
            ++taken;
        }
    ASSERT_GT(taken, 50u);
    EXPECT_EQ(compared(scene, records, kExact).lost, taken);
}

TEST(LiveError, IsSomeWhereARungIsCheaper) {
    EXPECT_GT(figuresOf("doughnut.glb", settingsWith({{"forceShading", "off"}})).direction.p99, 1e-3);
    EXPECT_GT(figuresOf("doughnut.glb", settingsWith({{"forceShading", "projected"}})).position.p50, 1e-8);
    EXPECT_GT(figuresOf("doughnut.glb", settingsWith({{"iterationBudget", "1"}})).position.p99, 1e-7);
    const LiveErrorFigures walked = figuresOf("doughnut.glb", settingsWith({{"contact", "neighbourhood"}}));
    EXPECT_GT(walked.position.p99, 1e-9);
    EXPECT_LT(walked.position.p50, 1e-4) << "it is the same surface";
}

TEST(LiveError, OfTheDefaultsIsTheTextureFiltersAlone) {
    const LiveErrorFigures figures = figuresOf("doughnut.glb", {});
    EXPECT_EQ(figures.position.p99, 0.0) << "the law leaves the geometry alone";
    EXPECT_GT(figures.force.p99, 0.0);
    EXPECT_LT(figures.forceShare.p99, 0.01);
    EXPECT_LT(figures.direction.p99, 0.01);
}

TEST(LiveError, TakesUpTheTouchBehindAGap) {
    const TouchedScene scene = test::touchedScene("doughnut.glb");
    std::vector<TickRecord> records = lived(scene, kExact, 3000);
    const auto lost = records.begin() + 1500;
    ASSERT_GT(lost->output.contacts, 0u);
    records.erase(lost, lost + 200);
    const LiveErrorFigures figures = compared(scene, records, kExact);
    EXPECT_EQ(figures.compared, 2798u) << "after each beginning one tick";
    EXPECT_LT(figures.position.p99, 1e-6);
    EXPECT_EQ(figures.lost + figures.invented, 0u);
    EXPECT_NEAR(figures.comparedShare, 2599.0 / 2800.0, 1e-9)
        << "of the newest 2800, 200 are the gap and one begins";
}

TEST(LiveError, DropsAndSaysSoWhereMoreComesThanWaits) {
    const TouchedScene scene = test::touchedScene("doughnut.glb");
    const std::vector<TickRecord> records = lived(scene, {}, 1000);
    LiveError error(kRate, 1.0, 400);
    error.sceneOffered(1, scene.haptic, scene.source);
    for (const TickRecord& record : records)
        error.take(record, {});
    error.drain();
    EXPECT_EQ(error.figures().dropped, 600u);
    EXPECT_EQ(error.figures().compared, 399u);
}

TEST(LiveError, FollowsTheScenes) {
    const TouchedScene first = test::touchedScene("doughnut.glb"), second = test::touchedScene("box.glb");
    std::vector<TickRecord> records = lived(first, kExact, 1500), more = lived(second, kExact, 1500);
    for (TickRecord& record : more) {
        record.scene = 2;
        record.step += records.size();
    }
    LiveError error(kRate, 3.0);
    error.sceneOffered(1, first.haptic, first.source);
    error.sceneOffered(2, second.haptic, second.source);
    for (const auto* batch : {&records, &more})
        for (const TickRecord& record : *batch)
            error.take(record, kExact);
    error.drain();
    const LiveErrorFigures figures = error.figures();
    EXPECT_EQ(figures.compared, 2998u);
    EXPECT_GT(figures.inContact, 1500u);
    EXPECT_EQ(figures.position.p99, 0.0);
}

} // namespace
} // namespace touchstone::study
