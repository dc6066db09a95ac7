// A hand that sculpts while it touches: what it feels, what is recorded, and what is left of the field.

#include "tests/unit/session/sculpting_hand.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <thread>
#include <vector>

namespace touchstone::test {
namespace {

size_t fieldIn(const HapticScene& scene) {
    for (size_t k = 0; k < scene.objects.size(); ++k)
        if (scene.objects[k]->shape != nullptr && scene.objects[k]->shape->potential() != nullptr)
            return k;
    return scene.objects.size();
}

double valueAt(const HapticScene& scene, size_t object, const glm::dvec3& place) {
    const Similarity& at = scene.objects[object]->workspaceFromObject;
    return at.scale * scene.objects[object]->shape->potential()->value(at.inversePoint(place));
}

/// The highest place of the field's surface on some vertical line, m.
glm::dvec3 topOf(const HapticScene& scene, size_t object) {
    const Similarity& at = scene.objects[object]->workspaceFromObject;
    const double reach = scene.objects[object]->boundingRadius * at.scale;
    glm::dvec3 best(0.0, -INFINITY, 0.0);
    for (double x = -reach; x < reach; x += 0.05 * reach)
        for (double y = reach; y > -reach; y -= 1e-4)
            if (const glm::dvec3 place = at.translation + glm::dvec3(x, y, 0.0);
                valueAt(scene, object, place) < 0.0) {
                if (place.y > best.y)
                    best = place;
                break;
            }
    return best;
}

class LiveSculptorTest : public testing::Test {
  protected:
    LiveSculptorTest() { recording_.recorder.start(file_, "test"); }
    void SetUp() override {
        session_.subscribe(recording_);
        ASSERT_LT(object_, scene_.haptic->objects.size());
        (void)session_.touch(scene_.haptic, scene_.source, scene_.identity);
    }
    void sculptFor(double seconds, SculptTool tool) {
        LiveTool live{
            .active = true, .tool = tool, .object = static_cast<int32_t>(object_), .radius = kToolRadius};
        live.stamp = live.object;
        sculptTicks(session_, live, static_cast<uint64_t>(4000.0 * seconds));
        endSculpting(session_);
    }
    [[nodiscard]] uint64_t hashOf(const std::vector<SculptEntry>& entries) const {
        SceneSculptor again(scene_.haptic);
        for (const SculptEntry& entry : entries)
            (void)again.apply(entry);
        again.settle();
        return again.hash();
    }

    const TouchedScene scene_ = touchedScene("field_torus.glb");
    const size_t object_ = fieldIn(*scene_.haptic);
    const glm::dvec3 top_ = topOf(*scene_.haptic, object_);
    RubbingDevice device_{top_};
    Session session_{{portOf(device_)}, RecordedServo::kQuick};
    Recording recording_{session_};
    const std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("sculpt_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".tsrec");
};

TEST_F(LiveSculptorTest, TheHandFeelsWhatItCarvesAndAReplayHasTheSameFieldHashForHash) {
    sculptFor(2.0, SculptTool::Carve);
    const SculptFigures figures = session_.sculptor().figures();
    EXPECT_GT(figures.dabs, 20u);
    EXPECT_GT(figures.removed, 0.0);
    EXPECT_TRUE(figures.problem.empty()) << figures.problem;
    EXPECT_EQ(session_.servo().droppedEdits(), 0u);
    EXPECT_GT(recording_.published, 10u);
    EXPECT_GT(recording_.edited, 5u) << "the servo took the scenes up while it ran";
    EXPECT_GT(recording_.contacts, 100u);
    EXPECT_GT(recording_.resisted, 0.0) << "the tool's resistance where the tip is in a hole of its own";
    EXPECT_LE(recording_.force, DeviceLimits{}.maxForce + 1e-9);
    ASSERT_NE(recording_.last.haptic, nullptr);
    EXPECT_LT(valueAt(*scene_.haptic, object_, top_ - glm::dvec3(0.0, 0.001, 0.0)), 0.0);
    EXPECT_GT(valueAt(*recording_.last.haptic, object_, top_ - glm::dvec3(0.0, 0.001, 0.0)), 0.0);
    EXPECT_EQ(recording_.last.hash, hashOf(recording_.entries));
    recording_.recorder.finish();
    expectEqualReplay(replayOf(file_, {scene_}));
}

TEST_F(LiveSculptorTest, WhatIsAddedLiftsTheHandWithoutLettingItGo) {
    sculptFor(1.5, SculptTool::Add);
    EXPECT_LT(session_.sculptor().figures().removed, 0.0);
    ASSERT_NE(recording_.last.haptic, nullptr);
    EXPECT_GT(recording_.contacts, 3000u) << "of 6000 ticks";
    EXPECT_LT(valueAt(*recording_.last.haptic, object_, top_ + glm::dvec3(0.0, 0.0003, 0.0)), 0.0);
    recording_.recorder.finish();
    expectEqualReplay(replayOf(file_, {scene_}));
}

TEST_F(LiveSculptorTest, StrokesOfEveryToolAreTakenBackToTheBytesOfBefore) {
    for (const SculptTool tool : {SculptTool::Carve, SculptTool::Smooth, SculptTool::Drag, SculptTool::Add,
                                  SculptTool::Stamp, SculptTool::Imprint})
        sculptFor(0.5, tool);
    const size_t strokes = session_.sculptor().figures().undoSteps;
    EXPECT_GE(strokes, 4u);
    const uint64_t sculpted = session_.sculptor().figures().hash;
    for (size_t i = 0; i < strokes; ++i)
        session_.sculptor().undo();
    session_.sculptor().drain();
    session_.pump(0.0);
    EXPECT_EQ(session_.sculptor().figures().undoSteps, 0u);
    EXPECT_EQ(recording_.last.hash, SceneSculptor(scene_.haptic).hash());
    EXPECT_EQ(fieldOfObject(*recording_.last.haptic, object_), fieldOfObject(*scene_.haptic, object_))
        << "the very grid";
    for (size_t i = 0; i < strokes; ++i)
        session_.sculptor().redo();
    session_.sculptor().drain();
    session_.pump(0.0);
    EXPECT_EQ(recording_.last.hash, sculpted);
    EXPECT_EQ(hashOf(recording_.entries), sculpted);
}

TEST_F(LiveSculptorTest, OtherMaterialsKeepTheSculptedFields) {
    sculptFor(0.6, SculptTool::Carve);
    const uint64_t sculpted = session_.sculptor().figures().hash;
    const TouchedScene stiffer =
        withChanged(scene_, [](HapticMaterial& material) { material.stiffness.value = 250.0f; });
    const uint32_t root =
        session_.touch(stiffer.haptic, stiffer.source, stiffer.identity, SceneSwap::SameGeometry, true);
    session_.pump(0.0);
    EXPECT_EQ(recording_.last.root, root);
    EXPECT_EQ(recording_.last.hash, sculpted);
    EXPECT_EQ(recording_.last.haptic->materials.front().stiffness,
              stiffer.haptic->materials.front().stiffness);
    sculptFor(0.4, SculptTool::Carve);
    EXPECT_TRUE(session_.touching());
    EXPECT_EQ(recording_.last.hash, hashOf(recording_.entries));
    recording_.recorder.finish();
    RecordingReader reader(file_);
    Replayer replayer([&](const RecordedScene& recorded) {
        const TouchedScene& offered = recorded.number == root ? stiffer : scene_;
        return ReplayScene{compileHapticScene(*offered.source, offered.haptic->workspaceFromScene),
                           offered.source};
    });
    expectEqualReplay(replayer.replay(reader));
}

TEST_F(LiveSculptorTest, AnotherModelIsNotSculptedByWhatWasMadeOnTheLastOne) {
    sculptFor(0.5, SculptTool::Carve);
    (void)session_.touch(scene_.haptic, scene_.source, scene_.identity);
    session_.sculptor().drain();
    session_.pump(0.0);
    EXPECT_EQ(session_.sculptor().figures().dabs, 0u);
    EXPECT_EQ(session_.sculptor().figures().undoSteps, 0u);
    session_.sculptor().undo();
    session_.sculptor().drain();
    EXPECT_EQ(session_.sculptor().figures().undoSteps, 0u);
}

TEST_F(LiveSculptorTest, EditsThatCannotBeAreRefusedAndNamed) {
    session_.sculptor().add({.kind = SculptEntryKind::Begin, .object = 99});
    session_.sculptor().drain();
    EXPECT_NE(session_.sculptor().figures().problem.find("99"), std::string::npos);
    session_.sculptor().add({.object = static_cast<int32_t>(object_), .radius = NAN});
    session_.sculptor().drain();
    EXPECT_FALSE(session_.sculptor().figures().problem.empty());
    session_.pump(0.0);
    EXPECT_EQ(recording_.published, 0u);
}

/// That a published scene has all that an earlier one had: of what is added alone.
struct GrowingSolid final : TickSubscriber {
    explicit GrowingSolid(size_t field) : object(field) {}
    void sceneOffered(const OfferedScene&) override {}
    void sceneSculpted(const SculptedScene& scene) override {
        for (const SculptEntry& entry : scene.entries) {
            if (entry.kind != SculptEntryKind::Begin && entry.kind != SculptEntryKind::Restore)
                centres.push_back(entry.centre);
            previews += entry.kind == SculptEntryKind::Preview ? 1 : 0;
            made += entry.kind == SculptEntryKind::Shape || entry.kind == SculptEntryKind::Dab ? 1 : 0;
        }
        for (const glm::dvec3& centre : centres)
            missing += scene.haptic->objects[object]->shape->potential()->value(centre) < 0.0 ? 0 : 1;
    }
    void take(const TickRecord&, const HapticSettings&) override {}
    void flush(double) override {}

    size_t object;
    std::vector<glm::dvec3> centres;
    size_t previews = 0, made = 0, missing = 0;
};

/// Dabs that come faster than their distances are restored, with begins of strokes between them.
TEST_F(LiveSculptorTest, WhatIsMadeWhileDistancesAreRestoredIsFeltAndStays) {
    GrowingSolid solid(object_);
    session_.subscribe(solid);
    session_.start();
    const Similarity& at = scene_.haptic->objects[object_]->workspaceFromObject;
    const double radius = 0.012 / at.scale;
    size_t added = 0;
    for (int i = 0; i < 600 && (i < 60 || solid.previews <= 5); ++i) {
        const auto object = static_cast<int32_t>(object_);
        if (i % 7 == 0)
            session_.sculptor().add({.kind = SculptEntryKind::Begin, .object = object});
        const glm::dvec3 place = top_ + glm::dvec3(0.0006 * (i % 30), 0.001 * (i % 3), 0.0);
        session_.sculptor().add({.tool = SculptTool::Add,
                                 .object = object,
                                 .tick = static_cast<uint64_t>(i) + 1,
                                 .centre = at.inversePoint(place),
                                 .radius = radius});
        ++added;
        std::this_thread::sleep_for(std::chrono::milliseconds(i % 10 == 0 ? 30 : 2));
        session_.pump(0.0);
    }
    endSculpting(session_);
    EXPECT_GT(solid.previews, 5u);
    EXPECT_EQ(solid.missing, 0u) << "what was felt stays";
    EXPECT_EQ(solid.made, session_.sculptor().figures().dabs) << "each dab is made once";
    EXPECT_EQ(solid.made + session_.sculptor().figures().thinned, added);
    EXPECT_EQ(recording_.last.hash, hashOf(recording_.entries));
    recording_.recorder.finish();
    expectEqualReplay(replayOf(file_, {scene_}));
}

} // namespace
} // namespace touchstone::test
