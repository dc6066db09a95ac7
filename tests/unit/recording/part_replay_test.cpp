// Objects that are hidden and come back while a hand touches them, and recordings of that.

#include "haptics/recording/recording_format.h"
#include "haptics/scene/scene_parts.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace touchstone::test::part_replay_test {
namespace {

/// Floors of 0.1 m around these places: node k and object k are the floor at the k-th.
TouchedScene floorsAt(const std::vector<glm::vec3>& places) {
    auto source = std::make_shared<Scene>();
    source->path = "floors";
    source->materials.emplace_back();
    for (const glm::vec3& place : places) {
        Mesh mesh;
        for (const glm::vec3& corner :
             {glm::vec3(-1, 0, -1), glm::vec3(-1, 0, 1), glm::vec3(1, 0, 1), glm::vec3(1, 0, -1)})
            mesh.positions.push_back(place + 0.05f * corner);
        mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
        mesh.indices = {0, 1, 2, 0, 2, 3};
        const int next = static_cast<int>(source->meshes.size());
        source->meshes.push_back(std::move(mesh));
        source->nodes.emplace_back();
        source->instances.push_back({.node = next, .mesh = next});
    }
    TouchedScene scene;
    scene.haptic = compileHapticScene(*source, Similarity{});
    scene.source = std::move(source);
    scene.identity = identify(*scene.haptic, *scene.source, Fit::None);
    return scene;
}

/// Two floors in y = 0, side by side along x.
TouchedScene twoFloors() {
    return floorsAt({{0.0f, 0.0f, 0.0f}, {0.2f, 0.0f, 0.0f}});
}

TouchedScene partOfFloors(const TouchedScene& whole, std::vector<int> hidden) {
    TouchedScene part = whole;
    part.identity.part.hidden = std::move(hidden);
    part.haptic = partOf(*whole.haptic, *whole.source, part.identity.part);
    part.identity.feltHash = feltHash(*part.haptic, *part.source);
    return part;
}

TEST(PartReplay, WhatIsHiddenLetsGoWhatIsBesideItDoesNot) {
    ScratchFolder scratch;
    const std::filesystem::path file = scratch / "parts.tsrec";
    std::atomic<double> height{0.01};
    RecordedServo rig([&](double) { return at({0.01, height.load(), 0.02}); });
    rig.recorder.start(file, "test");
    const TouchedScene whole = twoFloors();
    rig.offer(whole);
    rig.ticks(1000);
    height = -0.002;
    rig.ticks(1000);
    const auto force = [&] { return glm::length(rig.records.back().output.force); };
    const double before = force();
    ASSERT_GT(before, 1.0);

    const TouchedScene beside = partOfFloors(whole, {1});
    const size_t first = rig.records.size();
    rig.offer(beside, SceneSwap::SameGeometry);
    rig.ticks(500);
    EXPECT_EQ(force(), before) << "nothing that is touched has changed";
    for (size_t i = first; i < rig.records.size(); ++i)
        ASSERT_GT(rig.records[i].output.contacts, 0u);

    rig.offer(partOfFloors(whole, {0, 1}), SceneSwap::SameGeometry);
    rig.ticks(1000);
    EXPECT_EQ(force(), 0.0);
    EXPECT_EQ(glm::length(rig.records.back().output.command.force()), 0.0);

    // It comes back around the hand, which feels nothing until it has left: 2 mm below it, then 4 mm above.
    rig.offer(beside);
    rig.ticks(1000);
    EXPECT_EQ(force(), 0.0) << "2 mm below the floor";
    height = 0.004;
    rig.ticks(500);
    height = -0.001;
    rig.ticks(500);
    EXPECT_EQ(force(), 0.0) << "it was within reach all the time";
    height = 0.008;
    rig.ticks(500);
    height = -0.002;
    rig.ticks(2000);
    EXPECT_NEAR(force(), before, 1e-6 * before);
    rig.finish();
    rig.expectWithinLimits();
    expectEqualReplay(replayOf(file, rig.scenes));
}

/// A hand that begins 10 mm over `begin` and then presses 4 mm deep at `pressed`.
struct PressingHand {
    std::atomic<double> x, height{0.01};
    RecordedServo rig;
    ScratchFolder scratch;
    std::filesystem::path file = scratch / "pressed.tsrec";

    PressingHand(const TouchedScene& scene, double begin, double pressed)
        : x(begin), rig([this](double) {
              return at({x.load(), height.load(), 0.02});
          }) {
        rig.recorder.start(file, "test");
        rig.offer(scene);
        rig.ticks(500);
        x = pressed;
        rig.ticks(500);
        height = -0.004;
        rig.ticks(1000);
    }
    [[nodiscard]] double force() const { return glm::length(rig.records.back().output.force); }
    /// Every tick from here touches, and the force stays.
    void expectHeldOn(const TouchedScene& offered, SceneSwap swap = SceneSwap::SameGeometry) {
        const double before = force();
        ASSERT_GT(before, 1.0);
        const size_t first = rig.records.size();
        rig.offer(offered, swap);
        rig.ticks(500);
        for (size_t i = first; i < rig.records.size(); ++i)
            ASSERT_GT(rig.records[i].output.contacts, 0u) << i - first;
        EXPECT_NEAR(force(), before, (swap == SceneSwap::OtherPart ? 1e-6 : 1e-9) * before);
    }
    void expectReplay() {
        rig.finish();
        rig.expectWithinLimits();
        expectEqualReplay(replayOf(file, rig.scenes));
    }
};

/// In a scene at rest the reference object stays the one nearest to where touch began. Failed: hiding it
/// ended the touch of another one.
TEST(PartReplay, HidingWhatIsNotTouchedLetsGoOfNothing) {
    const TouchedScene whole = twoFloors();
    PressingHand hand(whole, 0.12, 0.01); // nearer to floor 1, on floor 0
    hand.expectHeldOn(partOfFloors(whole, {1}));
    hand.expectReplay();
}

/// Failed: with the reference object still there, the floor 3 mm behind pushed at 1 mm depth at once.
TEST(PartReplay, WhatStoodBehindTheHiddenPushesOnlyAfterTheHandHasLeft) {
    const TouchedScene whole = floorsAt({{0.0f, 0.0f, 0.0f}, {0.2f, 0.0f, 0.0f}, {0.0f, -0.003f, 0.0f}});
    PressingHand hand(whole, 0.12, 0.01);
    ASSERT_GT(hand.force(), 1.0);
    const size_t first = hand.rig.records.size();
    hand.rig.offer(partOfFloors(whole, {0}), SceneSwap::SameGeometry);
    hand.rig.ticks(1000);
    for (size_t i = first; i < hand.rig.records.size(); ++i)
        ASSERT_TRUE(hand.rig.records[i].scene == 1 || hand.rig.records[i].output.contacts == 0) << i - first;
    EXPECT_EQ(hand.force(), 0.0);
    hand.height = 0.01;
    hand.rig.ticks(500);
    hand.height = -0.004;
    hand.rig.ticks(2000);
    EXPECT_GT(hand.force(), 0.1) << "it has left, and comes back to the floor behind";
    hand.expectReplay();
}

/// Each edit is a scene: the recorder kept them all, half a kilobyte each, as long as a server ran.
TEST(ServoRecorder, ForgetsScenesThatNoRecordNamesAnyMore) {
    RecordedServo rig([](double) { return at({0.0, 0.02, 0.0}); });
    const TouchedScene floor = floorScene(0.0f);
    for (int i = 0; i < 20; ++i) {
        rig.offer(floor, SceneSwap::SameGeometry);
        rig.ticks(100);
        EXPECT_LE(rig.recorder.scenes(), 2u) << i;
    }
    const auto file = std::filesystem::path(testing::TempDir()) / "forgets_scenes.tsrec";
    rig.recorder.start(file, "test");
    rig.ticks(200);
    rig.finish();
    expectEqualReplay(replayOf(file, rig.scenes));
}

/// Failed: an object that was hidden before touch began was the reference object, and every other material
/// ended the touch.
TEST(PartReplay, MaterialsAreEditedBesideAHiddenObject) {
    const TouchedScene whole = twoFloors();
    const TouchedScene part = partOfFloors(whole, {0});
    PressingHand hand(part, 0.01, 0.19); // over the hidden floor
    hand.expectHeldOn(
        withChanged(part, [](HapticMaterial& material) { material.dynamicFriction.value = 0.9f; }));
    hand.expectReplay();
}

/// The whole way of the window's flight recorder: hash, part and back.
TEST(PartReplay, TheRecordingKnowsThePart) {
    RecordedScene scene{3, {}};
    scene.identity.path = "floors.glb";
    scene.identity.part.hidden = {1, 4, 70000};
    scene.identity.part.clip = clipPlane({1, 2, -2}, 0.25);
    const auto again = std::get<RecordedScene>(decode(1, encode(scene)));
    EXPECT_EQ(again.identity.part, scene.identity.part);
    EXPECT_EQ(again.identity.edits, "");
    scene.identity.edits = "{}";
    scene.identity.part.clip.reset();
    EXPECT_EQ(std::get<RecordedScene>(decode(1, encode(scene))).identity.part, scene.identity.part);
    scene.identity.part.hidden = {4, 1};
    EXPECT_THROW((void)decode(1, encode(scene)), Error);
    scene.identity.part.hidden = {-1};
    EXPECT_THROW((void)decode(1, encode(scene)), Error);
    scene.identity.part = {};
    scene.identity.part.clip = ClipPlane{glm::dvec3(0.0), 1.0};
    EXPECT_THROW((void)decode(1, encode(scene)), Error);
    for (const double length : {1.0 - 1e-8, 1.0 + 1e-8, 2.0, 1e-200, 1e200}) {
        scene.identity.part.clip = ClipPlane{glm::dvec3(0, length, 0), 1.0};
        EXPECT_THROW((void)decode(1, encode(scene)), Error) << length;
    }
    scene.identity.part.clip = ClipPlane{glm::dvec3(1, 0, 0), std::nan("")};
    EXPECT_THROW((void)decode(1, encode(scene)), Error);
}

TouchedScene cutAt(const TouchedScene& whole, const glm::dvec3& normal, double offset) {
    TouchedScene part = whole;
    part.identity.part.clip = clipPlane(normal, offset);
    part.haptic = partOf(*whole.haptic, *whole.source, part.identity.part);
    part.identity.feltHash = feltHash(*part.haptic, *part.source);
    return part;
}

/// Along the floor a plane comes nearer to the hand, which feels nothing of it until the floor under it is
/// gone; where the floor comes back through the hand it has to leave first.
TEST(PartReplay, AHandHoldsOnWhileAPlaneMovesBesideIt) {
    const TouchedScene whole = twoFloors();
    PressingHand hand(whole, 0.01, 0.01);
    const double before = hand.force();
    for (const double offset : {0.23, 0.2, 0.04, 0.03, 0.0301, 0.02, 0.011})
        hand.expectHeldOn(cutAt(whole, {1, 0, 0}, offset), SceneSwap::OtherPart);
    hand.expectHeldOn(whole, SceneSwap::OtherPart);
    EXPECT_NEAR(hand.force(), before, 1e-9 * before);
    const auto expectNone = [&](const TouchedScene& offered) {
        hand.rig.offer(offered, SceneSwap::OtherPart);
        hand.rig.ticks(1000);
        EXPECT_EQ(hand.rig.records.back().output.contacts, 0u);
        EXPECT_EQ(glm::length(hand.rig.records.back().output.command.force()), 0.0);
    };
    expectNone(cutAt(whole, {1, 0, 0}, 0.0)); // the floor under the hand is gone
    hand.height = 0.0;
    hand.rig.ticks(500);
    expectNone(whole); // it comes back through the hand
    hand.height = 0.01;
    hand.rig.ticks(500);
    hand.height = -0.004;
    hand.rig.ticks(2000);
    EXPECT_NEAR(hand.force(), before, 1e-6 * before);
    hand.expectReplay();
}

/// Through its cut a hand is in a ball and presses on its wall. It holds on while the cut changes, and is let
/// go where the ball closes around it; outside it holds on in either case.
TEST(PartReplay, ABallThatClosesAroundTheHandLetsItGo) {
    auto source = std::make_shared<Scene>(sceneOf(assets::sphere(0.05, 32, 64)));
    TouchedScene whole;
    whole.haptic = compileHapticScene(*source, Similarity{});
    whole.source = std::move(source);
    whole.identity = identify(*whole.haptic, *whole.source, Fit::None);
    const TouchedScene half = cutAt(whole, {0, 1, 0}, 0.0);

    PressingHand inside(half, 0.0, 0.0);
    const auto goTo = [](PressingHand& hand, double x, double height) {
        const double fromX = hand.x, fromHeight = hand.height;
        for (int i = 1; i <= 50; ++i) {
            hand.x = fromX + (x - fromX) * i / 50.0;
            hand.height = fromHeight + (height - fromHeight) * i / 50.0;
            hand.rig.ticks(10);
        }
        hand.rig.ticks(200);
    };
    inside.height = 0.08;
    inside.rig.offer(half); // the hand is out of it
    inside.rig.ticks(500);
    goTo(inside, 0.0, -0.02);
    EXPECT_EQ(inside.rig.records.back().output.contacts, 0u);
    goTo(inside, 0.0, -0.05); // the wall at z = 0.02 is 46 mm below the middle
    for (const double offset : {0.005, -0.005, 0.03, 0.0})
        inside.expectHeldOn(cutAt(whole, {0, 1, 0}, offset), SceneSwap::OtherPart);
    inside.rig.offer(whole, SceneSwap::OtherPart);
    inside.rig.ticks(1000);
    EXPECT_EQ(inside.rig.records.back().output.contacts, 0u) << "it has closed around the hand";
    EXPECT_EQ(glm::length(inside.rig.records.back().output.command.force()), 0.0);
    inside.expectReplay();

    PressingHand outside(half, 0.0, 0.0);
    outside.height = 0.08;
    outside.rig.offer(half);
    outside.rig.ticks(500);
    goTo(outside, 0.08, 0.08);
    goTo(outside, 0.08, -0.08);
    goTo(outside, 0.0, -0.08);
    goTo(outside, 0.0, -0.043); // 3 mm deep
    for (const double offset : {0.005, -0.005, 0.03})
        outside.expectHeldOn(cutAt(whole, {0, 1, 0}, offset), SceneSwap::OtherPart);
    outside.expectHeldOn(whole, SceneSwap::OtherPart);
    outside.expectReplay();
}

/// Where the next offer comes before its tick the servo never sees a part: the one after it has other
/// materials, and no floor under the hand either.
TEST(PartReplay, APartThatWasNeverFeltIsNotMissed) {
    const TouchedScene whole = twoFloors();
    PressingHand hand(whole, 0.01, 0.01);
    const TouchedScene cut = cutAt(whole, {1, 0, 0}, 0.0);
    hand.rig.offer(cut, SceneSwap::OtherPart);
    hand.rig.offer(withChanged(cut, [](HapticMaterial&) {}), SceneSwap::SameGeometry);
    hand.rig.ticks(1000);
    EXPECT_EQ(hand.rig.records.back().output.contacts, 0u);
}

} // namespace
} // namespace touchstone::test::part_replay_test
