// A hand holds on while a plane moves in scenes that have more state than the hand's: bodies, deforming
// meshes, persistent textures. All of it goes on, and replays.

#include "engine/program/surface_program.h"
#include "haptics/scene/scene_parts.h"
#include "haptics/texture/persistent_textures.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "tests/support/test_shapes.h"
#include "tests/unit/body/body_maker.h"
#include "tests/unit/deforming/deforming_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

namespace touchstone::test::part_worlds_replay_test {
namespace {

TouchedScene compiled(ScenePtr source) {
    TouchedScene scene;
    scene.haptic = compileHapticScene(*source, Similarity{});
    scene.source = std::move(source);
    scene.identity = identify(*scene.haptic, *scene.source, Fit::None);
    return scene;
}

TouchedScene partOfScene(const TouchedScene& whole, const ScenePart& wanted) {
    TouchedScene part = whole;
    part.identity.part = wanted;
    part.haptic = partOf(*whole.haptic, *whole.source, wanted);
    part.identity.feltHash = feltHash(*part.haptic, *part.source);
    return part;
}

TouchedScene cutAlongX(const TouchedScene& whole, double offset) {
    ScenePart part;
    part.clip = clipPlane({1, 0, 0}, offset);
    return partOfScene(whole, part);
}

/// A servo whose hand is pressed onto what is below it, and a recording of it.
struct HeldHand {
    std::atomic<double> x, height;
    ScratchFolder scratch;
    std::filesystem::path file = scratch / "held.tsrec";
    RecordedServo rig;

    HeldHand(const TouchedScene& scene, double place, double above, double pressed,
             const ServoConfig& config = RecordedServo::kQuick)
        : x(place), height(above), rig(
                                       [this](double) {
                                           return at({x.load(), height.load(), 0.02});
                                       },
                                       config) {
        rig.recorder.start(file, "test");
        rig.offer(scene);
        rig.ticks(500);
        for (int i = 1; i <= 20; ++i) {
            height = above + (pressed - above) * i / 20.0;
            rig.ticks(40);
        }
        rig.ticks(500);
    }
    [[nodiscard]] double force() const { return glm::length(rig.records.back().output.force); }
    /// Until the scene that was offered last has been felt for `count` ticks at least.
    void ticksOfLast(uint64_t count) {
        do
            rig.ticks(count);
        while (rig.records.back().scene < rig.scenes.size());
        rig.ticks(count);
    }
    /// Ticks of the part: each touches, and none changes the force by more than `step` N, but those that make
    /// up for ticks that the servo or the vertices stood still.
    void expectHeldOn(const TouchedScene& part, double step) {
        ASSERT_GT(force(), 0.5) << "before scene " << rig.scenes.size() + 1 << ", flags "
                                << rig.records.back().output.flags;
        const size_t first = rig.records.size();
        rig.offer(part, SceneSwap::OtherPart);
        ticksOfLast(200);
        double greatest = 0.0;
        for (size_t i = first; i < rig.records.size(); ++i) {
            const HapticOutput &now = rig.records[i].output, &before = rig.records[i - 1].output;
            ASSERT_GT(now.contacts, 0u) << i - first;
            if (rig.records[i].tick == rig.records[i - 1].tick + 1 &&
                !has(before.flags, TickFlag::DeformationHeld))
                greatest = std::max(greatest, glm::length(now.force - before.force));
        }
        EXPECT_LE(greatest, step);
    }
    void expectReplay() {
        rig.finish();
        rig.expectWithinLimits();
        expectEqualReplay(replayOf(file, rig.scenes));
    }
};

/// A table with its top in y = 0 that rests, and a block that falls beside it from y = 0.5.
TouchedScene tableAndBlock() {
    BodyMaker maker;
    (void)maker.surface(0.4, 0.2);
    (void)addCube(maker, "table", {0.0, -0.05, 0.0}, 0.1, 0.0);
    (void)addCube(maker, "block", {0.2, 0.5, 0.0}, 0.04, 0.1);
    return compiled(maker.scene());
}

TEST(PartWorldsReplay, BodiesGoOnWhileAPlaneMovesAndAHandHoldsOn) {
    const TouchedScene whole = tableAndBlock();
    HeldHand hand(whole, -0.02, 0.01, -0.004);
    const double before = hand.force();
    const auto blockAt = [&] {
        double height = INFINITY; // the first body of the file is the block
        for (const body::Pose& pose : hand.rig.servo.bodyPoses()->workspaceFromBody)
            if (pose.position.x > 0.1)
                height = std::min(height, pose.position.y);
        return height;
    };
    double last = blockAt();
    EXPECT_LT(last, 0.5) << "it falls";
    // The block is cut, it is gone, so is a part of the table; all comes back.
    for (const double offset : {0.21, 0.205, 0.1, 0.04, 0.03, 0.21}) {
        hand.expectHeldOn(cutAlongX(whole, offset), 1e-6 * before);
        EXPECT_LE(blockAt(), last + 1e-9) << "it goes on from where it was: " << offset;
        last = blockAt();
    }
    hand.expectHeldOn(whole, 1e-6 * before);
    EXPECT_LE(blockAt(), last + 1e-9);
    EXPECT_NEAR(hand.force(), before, 1e-6 * before);
    EXPECT_LT(blockAt(), 0.0);
    hand.expectReplay();
}

/// A replay makes the bodies out of a part: they are those of the whole. By what is left of its object, a
/// block that is cut or hidden would have a smaller radius, which decides when it falls asleep.
TEST(PartWorldsReplay, BodiesOfAPartAreThoseOfTheWhole) {
    const TouchedScene whole = tableAndBlock();
    const auto expected = body::BodyWorld::make(*whole.source, *whole.haptic);
    ScenePart hidden;
    for (size_t n = 0; n < whole.source->nodes.size(); ++n)
        hidden.hidden.push_back(static_cast<int>(n));
    for (const TouchedScene& part :
         {cutAlongX(whole, 0.21), cutAlongX(whole, -1.0), partOfScene(whole, hidden)}) {
        const auto made = body::BodyWorld::make(*part.source, *part.haptic);
        ASSERT_EQ(made->masses().size(), expected->masses().size());
        for (size_t b = 0; b < made->masses().size(); ++b) {
            EXPECT_EQ(made->masses()[b].radius, expected->masses()[b].radius);
            EXPECT_EQ(made->masses()[b].inverse, expected->masses()[b].inverse);
            EXPECT_EQ(made->states()[b].pose.position, expected->states()[b].pose.position);
        }
    }
}

/// A sheet of 0.1 m that a morph target moves up and down by 1 mm, and one at its side that rests.
TouchedScene wavingSheets() {
    MorphCase made;
    for (const double x : {-0.05, 0.05})
        for (const double z : {-0.05, 0.05})
            made.positions.emplace_back(static_cast<float>(x), 0.0f, static_cast<float>(z));
    made.indices = {0, 1, 2, 1, 3, 2};
    made.targets.assign(1, std::vector<glm::vec3>(4, {0.0f, 0.001f, 0.0f}));
    made.times = {0.0f, 0.5f, 1.0f};
    made.weights = {0.0f, 1.0f, 0.0f};
    auto source = std::make_shared<Scene>(sceneOfMorph(made));
    source->path = "sheets";
    Mesh beside = source->meshes[0];
    beside.deformation = nullptr;
    beside.sources.clear();
    for (glm::vec3& p : beside.positions)
        p.x += 0.2f;
    source->meshes.push_back(std::move(beside));
    source->nodes.emplace_back();
    source->instances.push_back({.node = 1, .mesh = 1});
    return compiled(std::move(source));
}

TEST(PartWorldsReplay, AHandHoldsOnToADeformingSheetWhileAPlaneMovesBesideIt) {
    const TouchedScene whole = wavingSheets();
    HeldHand hand(whole, 0.01, 0.01, -0.003);
    // 2 mm/s of the sheet and 600 N/m make 0.3 mN a tick at 4 kHz.
    constexpr double kStep = 0.05;
    for (const double offset : {0.23, 0.2, 0.16, 0.1, 0.06, 0.2})
        hand.expectHeldOn(cutAlongX(whole, offset), kStep);
    hand.expectHeldOn(whole, kStep);
    // A sheet that is cut stands in its static pose: the hand holds on or begins anew, within its limits.
    hand.rig.offer(cutAlongX(whole, 0.03), SceneSwap::OtherPart);
    hand.rig.ticks(1000);
    hand.rig.offer(whole, SceneSwap::OtherPart);
    hand.rig.ticks(1000);
    hand.expectReplay();
}

/// A hand on the sheet at its highest. A material is edited and the animation wound on in one offer: the
/// vertices of the preceding tick are not among those that were published ahead. So it is where the servo or
/// the thread that offers stands still for longer than is published.
struct WoundOn {
    TouchedScene whole = wavingSheets();
    HapticSettings settings{.animationSpeed = 0.0, .animationOffset = 0.5};
    HeldHand hand;

    explicit WoundOn(const ServoConfig& config = RecordedServo::kQuick)
        : hand(whole, 0.01, 0.01, -0.003, config) {
        hand.rig.servo.setSettings(settings);
        hand.rig.ticks(400);
    }
    /// Ticks without contact until the edited scene has been felt for 200 at least.
    size_t leftBy(double offset) {
        const size_t first = hand.rig.records.size();
        settings.animationOffset = offset;
        const TouchedScene edited = withChanged(whole, [](HapticMaterial& m) { m.stiffness.value = 500.0f; });
        hand.rig.scenes.push_back(edited);
        hand.rig.recorder.sceneOffered(
            hand.rig.servo.offerScene(edited.haptic, edited.source, SceneSwap::SameGeometry, &settings),
            edited.identity);
        hand.ticksOfLast(200);
        const auto since = hand.rig.records.begin() + static_cast<std::ptrdiff_t>(first);
        return static_cast<size_t>(std::count_if(since, hand.rig.records.end(), [](const TickRecord& record) {
            return record.output.contacts == 0;
        }));
    }
};

/// The scene is taken up as soon as its vertices of the preceding tick are published. Touch began anew at
/// once, also where a machine was so busy that the servo stood still for 25 ms.
TEST(PartWorldsReplay, AnEditedSceneWaitsForTheVerticesOfTheLastTick) {
    WoundOn wound;
    ASSERT_GT(wound.hand.force(), 0.5);
    for (const double offset : {0.9, 0.25, 0.5}) {
        EXPECT_EQ(wound.leftBy(offset), 0u) << offset;
        ASSERT_GT(wound.hand.force(), 0.5);
    }
    wound.hand.expectReplay();
}

/// A servo that does not wait. Once the hand went on, taken over on the vertices of the animation's start, 1
/// mm lower.
TEST(PartWorldsReplay, AHandBeginsAnewWhereTheVerticesOfTheLastTickAreNotThere) {
    ServoConfig config = RecordedServo::kQuick;
    config.longestAside = 0.0;
    WoundOn wound(config);
    HeldHand& hand = wound.hand;
    ASSERT_GT(hand.force(), 0.5);
    for (const double offset : {0.9, 0.25, 0.5}) {
        EXPECT_GT(wound.leftBy(offset), 0u) << "touch begins anew: " << offset;
        // It began where it was, under the sheet: round the sheet's edge and down on it again.
        hand.x = 0.1;
        hand.rig.ticks(200);
        hand.height = 0.01;
        hand.rig.ticks(200);
        hand.x = 0.01;
        hand.rig.ticks(600);
        hand.height = -0.003;
        hand.rig.ticks(600);
        ASSERT_GT(hand.force(), 0.5) << "and goes on";
    }
    hand.expectReplay();
}

/// A square of 0.1 m under plaque in y = 0, and one beside it.
TouchedScene plaqueSheets() {
    const nlohmann::json shader{{"source", "plaque.glsl"},
                                {"persistentTexture", {{"width", 128}, {"height", 128}}}};
    auto source = std::make_shared<Scene>();
    source->path = "plaque";
    source->materials.emplace_back();
    const glm::dmat4 up = glm::rotate(glm::dmat4(1.0), -0.5 * std::numbers::pi, glm::dvec3(1.0, 0.0, 0.0));
    place(*source, quadMesh(0.05, 4), 0, up);
    place(*source, quadMesh(0.05, 4), 0, glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.0, 0.0)) * up);
    const auto program = compileSurfaceProgram(
        "plaque.glsl",
        "void touch(const in Touch before, inout Surface after) {\n"
        "after.staticFriction = mix(0.1, 0.6, before.persistent);\n"
        "after.dynamicFriction = mix(0.05, 0.5, before.persistent);\n"
        "after.persistentChange = -1e-6 * length(before.force); after.brush = 0.004;\n}\n",
        {}, [] { return false; });
    source->materials[0].haptic.program = materialProgram(program, shader);
    return compiled(std::move(source));
}

TEST(PartWorldsReplay, APersistentTextureStaysAsTouchHasMadeItWhileAPlaneMoves) {
    const TouchedScene whole = plaqueSheets();
    HeldHand hand(whole, 0.0, 0.01, -0.003);
    const auto left = [&] { return hand.rig.recorder.textures()->at(0)->mean(); };
    double last = left();
    EXPECT_LT(last, 0.99999) << "it was brushed";
    for (const double offset : {0.23, 0.1, 0.045, 0.03, 0.02, 0.045, 0.2}) {
        hand.expectHeldOn(cutAlongX(whole, offset), 1e-3);
        EXPECT_LT(left(), last) << "worn on from where it was: " << offset;
        last = left();
    }
    ScenePart hidden;
    hidden.hidden = {1};
    hand.expectHeldOn(partOfScene(whole, hidden), 1e-3);
    hand.expectHeldOn(whole, 1e-3);
    EXPECT_LT(left(), last);
    EXPECT_EQ(hand.rig.recorder.textures()->at(1)->mean(), 1.0);
    hand.expectReplay();
}

/// What is hidden and comes back has the texture that it had.
TEST(PartWorldsReplay, AHiddenObjectKeepsItsTexture) {
    const TouchedScene whole = plaqueSheets();
    HeldHand hand(whole, 0.0, 0.01, -0.003);
    ScenePart hidden;
    hidden.hidden = {0};
    hand.rig.offer(partOfScene(whole, hidden), SceneSwap::OtherPart);
    hand.rig.ticks(500);
    EXPECT_EQ(hand.rig.records.back().output.contacts, 0u);
    const double worn = hand.rig.recorder.textures()->at(0)->mean();
    EXPECT_LT(worn, 0.99999);
    hand.height = 0.01;
    hand.rig.ticks(200);
    hand.rig.offer(whole, SceneSwap::OtherPart);
    hand.rig.ticks(500);
    EXPECT_EQ(hand.rig.recorder.textures()->at(0)->mean(), worn);
    hand.expectReplay();
}

} // namespace
} // namespace touchstone::test::part_worlds_replay_test
