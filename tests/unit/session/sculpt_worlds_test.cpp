// A hand sculpts in scenes that have more state than the hand's and the field's: bodies, deforming and soft
// meshes. None of it begins anew with a dab, and all of it replays.

#include "engine/load/scene_loader.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/world/driven_objects.h"
#include "haptics/world/soft_states.h"
#include "tests/support/program.h"
#include "tests/support/test_shapes.h"
#include "tests/unit/body/body_maker.h"
#include "tests/unit/deforming/deforming_bench.h"
#include "tests/unit/session/sculpting_hand.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone::test {
namespace {

constexpr double kSide = 0.04, kVoxel = 0.001; // m, of the clay
/// Of the servo with each tool. Under the thread sanitizer, beside other work, 4000 gave 18 to 20 dabs in
/// all.
#ifdef __SANITIZE_THREAD__
constexpr uint64_t kTicks = 8000;
#else
constexpr uint64_t kTicks = 4000;
#endif
const glm::dvec3 kClay(-0.3, 0.0, 0.0); // its middle, beside everything else

/// The scene and a cube of clay, in its frame: a field.
TouchedScene withClay(const Scene& scene, const std::string& name) {
    auto source = std::make_shared<Scene>(scene);
    source->path = name;
    Material& clay = source->materials.emplace_back();
    clay.haptic.implicit = true;
    clay.haptic.voxelSize = static_cast<float>(kVoxel);
    BodyMaker maker;
    (void)maker.surface(0.4, 0.2);
    (void)addCube(maker, "clay", {}, kSide, 0.0);
    const ScenePtr cube = maker.scene();
    Mesh& mesh = source->meshes.emplace_back(cube->meshes[static_cast<size_t>(cube->instances[1].mesh)]);
    mesh.material = static_cast<int>(source->materials.size()) - 1;
    for (glm::vec3& p : mesh.positions) {
        p += glm::vec3(kClay);
        source->bounds.include(glm::dvec3(p));
    }
    source->nodes.emplace_back();
    source->instances.push_back({.node = static_cast<int>(source->nodes.size()) - 1,
                                 .mesh = static_cast<int>(source->meshes.size()) - 1});
    TouchedScene made;
    made.haptic = compileHapticScene(*source, Similarity{});
    made.source = std::move(source);
    made.identity = identify(*made.haptic, *made.source, Fit::None);
    return made;
}

/// A stack of three blocks that fall over one another, for longer than the hand sculpts.
TouchedScene besideBodies() {
    BodyMaker maker;
    (void)maker.surface(0.4, 0.2);
    (void)addCube(maker, "table", {0.0, -0.05, 0.0}, 0.1, 0.0);
    for (int i = 0; i < 3; ++i)
        (void)addCube(maker, "block", {0.012 * i, 0.05 + 0.1 * i, 0.0}, 0.04, 0.1);
    return withClay(*maker.scene(), "bodies");
}

/// A sheet that a morph target moves up and down.
TouchedScene besideASheet() {
    MorphCase made;
    for (const double x : {-0.05, 0.05})
        for (const double z : {-0.05, 0.05})
            made.positions.emplace_back(static_cast<float>(x), 0.0f, static_cast<float>(z));
    made.indices = {0, 1, 2, 1, 3, 2};
    made.targets.assign(1, std::vector<glm::vec3>(4, {0.0f, 0.001f, 0.0f}));
    made.times = {0.0f, 0.5f, 1.0f};
    made.weights = {0.0f, 1.0f, 0.0f};
    return withClay(sceneOfMorph(made), "sheet");
}

TouchedScene besideFile(const std::string& file) {
    return withClay(*loadScene(std::filesystem::path(TOUCHSTONE_ASSETS) / file), file);
}

/// A block that rests unless a caller moves it.
TouchedScene besideABlock() {
    BodyMaker maker;
    (void)maker.surface(0.4, 0.2);
    (void)addCube(maker, "block", {0.0, 0.0, 0.0}, 0.04, 0.0);
    return withClay(*maker.scene(), "block");
}

struct World {
    std::string name;
    std::function<TouchedScene()> scene;
    bool driven = false; ///< a caller moves its last object
};

class SculptWorld : public testing::Test {
  protected:
    SculptWorld() {
        session_.subscribe(recording_);
        recording_.recorder.start(file_, "test");
    }
    void sculpt(const TouchedScene& scene, SculptTool tool, uint64_t ticks) {
        sculptTicks(session_,
                    {.active = true,
                     .tool = tool,
                     .object = static_cast<int32_t>(scene.haptic->objects.size() - 1),
                     .radius = kToolRadius},
                    ticks);
    }
    /// A caller lifts the object before the clay by 0.5 m, slowly.
    static std::shared_ptr<DrivenObjects> lifted(const TouchedScene& scene) {
        auto driven = std::make_shared<DrivenObjects>();
        const size_t block = scene.haptic->objects.size() - 2;
        const Similarity rest = scene.haptic->restMotions[block].workspaceFromObject;
        EXPECT_TRUE(driven->drive(static_cast<int>(block), rest,
                                  Similarity{.translation = {0.0, 0.5, 0.0}} * rest, 0.01, 0.0));
        return driven;
    }
    /// What moves besides the hand: bodies' and soft bodies' places.
    [[nodiscard]] std::vector<double> heights() {
        std::vector<double> heights;
        if (const body::BodyPoses* poses = session_.servo().bodyPoses())
            for (const body::Pose& pose : poses->workspaceFromBody)
                heights.push_back(pose.position.y);
        return heights;
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
    RubbingDevice device_{kClay + glm::dvec3(0.0, 0.5 * kSide, 0.0)};
    Session session_{{portOf(device_)}, RecordedServo::kQuick};
    Recording recording_{session_};
};

class SculptWorlds : public SculptWorld, public testing::WithParamInterface<World> {};

TEST_P(SculptWorlds, GoOnWhileAHandSculpts) {
    const TouchedScene scene = GetParam().scene();
    const std::shared_ptr<DrivenObjects> driven = GetParam().driven ? lifted(scene) : nullptr;
    (void)session_.touch(scene.haptic, scene.source, scene.identity, SceneSwap::Anew, false, driven);
    const SoftStates* const soft = session_.servo().soft();
    const std::vector<double> before = heights();
    for (const SculptTool tool : {SculptTool::Carve, SculptTool::Add, SculptTool::Smooth})
        sculpt(scene, tool, kTicks);
    constexpr size_t kTouched = 300; // ticks; a hand that jumps, since its process stood still, touches less
    for (int more = 0; more < 10 && recording_.contacts <= kTouched; ++more)
        sculpt(scene, SculptTool::Smooth, kTicks);
    endSculpting(session_);
    const SculptFigures figures = session_.sculptor().figures();
    EXPECT_TRUE(figures.problem.empty()) << figures.problem;
    EXPECT_GT(figures.dabs, 20u);
    EXPECT_GT(recording_.edited, 10u) << "the servo took the scenes up while it ran";
    EXPECT_GT(recording_.contacts, kTouched);
    EXPECT_EQ(session_.servo().soft(), soft) << "the soft bodies began anew";
    const std::vector<double> after = heights();
    for (size_t b = 0; b < before.size(); ++b)
        EXPECT_LT(after[b], before[b] - 0.005) << "body " << b << " falls";
    if (driven != nullptr) {
        ASSERT_EQ(driven->newest().count, 1u);
        const DrivenPose& block = driven->newest().poses()[0];
        const double seconds =
            static_cast<double>(session_.servo().counters().ticks) / RecordedServo::kQuick.rateHz;
        EXPECT_GT(block.now.translation.y, 0.009 * seconds) << "it goes on; farther where ticks were skipped";
    }
    recording_.recorder.finish();
    const ReplayReport report = replayOf(file_, {scene});
    expectEqualReplay(report);
    EXPECT_EQ(report.ticks, session_.servo().counters().ticks);
}

/// Where a replay of the file says that the caller's one object is, by tick.
std::map<uint64_t, glm::dvec3> movedIn(const std::filesystem::path& file, const TouchedScene& scene) {
    Replayer replayer([&](const RecordedScene&) { return ReplayScene{scene.haptic, scene.source}; });
    RecordingReader reader(file);
    std::map<uint64_t, glm::dvec3> places;
    const ReplayReport report =
        replayer.replay(reader, [&](const RecordedTick& tick, const HapticOutput&, int64_t, bool) {
            if (replayer.moved().size() == 1)
                places[tick.tick] = replayer.moved()[0].now.translation;
        });
    EXPECT_FALSE(report.first.has_value());
    return places;
}

/// The timeline replays from the middle: from an edit, before which the root has touched nothing.
TEST_F(SculptWorld, AReplayThatBeginsAtAnEditTellsWhereACallersObjectsAre) {
    const TouchedScene scene = besideABlock();
    (void)session_.touch(scene.haptic, scene.source, scene.identity, SceneSwap::Anew, false, lifted(scene));
    sculpt(scene, SculptTool::Carve, 6000);
    endSculpting(session_);
    recording_.recorder.finish();
    const std::map<uint64_t, glm::dvec3> whole = movedIn(file_, scene);
    std::vector<RecordedItem> items = itemsOf(file_);
    size_t index = 0;
    const auto ofFirstHalf = [&](const RecordedItem& item) {
        return index++ < items.size() / 2 && (std::holds_alternative<RecordedTicks>(item) ||
                                              std::holds_alternative<TouchCheckpoint>(item) ||
                                              std::holds_alternative<RecordedDriven>(item));
    };
    std::vector<RecordedItem> second;
    for (const RecordedItem& item : items)
        if (!ofFirstHalf(item))
            second.push_back(item);
    writeItems(file_, second);
    const std::map<uint64_t, glm::dvec3> half = movedIn(file_, scene);
    EXPECT_GT(half.size(), 1000u);
    EXPECT_LT(half.size(), whole.size());
    for (const auto& [tick, place] : half)
        ASSERT_EQ(place, whole.at(tick)) << tick;
}

INSTANTIATE_TEST_SUITE_P(All, SculptWorlds,
                         testing::Values(World{"Bodies", besideBodies}, World{"DeformingSheet", besideASheet},
                                         World{"Cloth", [] { return besideFile("cloth.glb"); }},
                                         World{"Jelly", [] { return besideFile("jelly.glb"); }},
                                         World{"DrivenBlock", besideABlock, true}),
                         [](const auto& world) { return world.param.name; });

} // namespace
} // namespace touchstone::test
