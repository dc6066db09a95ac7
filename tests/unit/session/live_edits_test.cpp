// Edits of every kind that come faster than they are made: what is published is what its journal says.

#include "engine/load/scene_loader.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "tests/unit/session/sculpting_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <thread>

namespace touchstone::test {
namespace {

/// Two bodies of clay, side by side in the workspace.
TouchedScene twoTori() {
    const ScenePtr one = loadScene(std::filesystem::path(TOUCHSTONE_ASSETS) / "field_torus.glb");
    auto source = std::make_shared<Scene>(*one);
    const glm::dvec3 beyond(1.2 * (one->bounds.high.x - one->bounds.low.x), 0.0, 0.0);
    Instance beside = source->instances.front();
    beside.sceneFromMesh[3] += glm::dvec4(beyond, 0.0);
    source->instances.push_back(beside);
    source->bounds.include(source->bounds.high + beyond);
    TouchedScene scene;
    scene.haptic = compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace));
    scene.identity = identify(*scene.haptic, *source, Fit::Workspace);
    scene.source = std::move(source);
    return scene;
}

/// Makes the published entries again, one publication after the other.
struct JournalFollower final : TickSubscriber {
    void sceneOffered(const OfferedScene& scene) override { offered[scene.number] = scene.haptic; }
    void sceneSculpted(const SculptedScene& scene) override {
        if (scene.root != root || !sculptor)
            sculptor.emplace(offered.at(scene.root));
        root = scene.root;
        for (const SculptEntry& entry : scene.entries) {
            (void)sculptor->apply(entry);
            ++kinds[entry.kind];
        }
        sculptor->settle();
        others += sculptor->hash() == scene.hash ? 0 : 1;
        ++published;
    }
    void take(const TickRecord&, const HapticSettings&) override {}
    void flush(double) override {}

    std::map<uint32_t, std::shared_ptr<const HapticScene>> offered;
    std::optional<SceneSculptor> sculptor;
    uint32_t root = 0;
    std::map<SculptEntryKind, size_t> kinds;
    size_t published = 0, others = 0;
};

/// A stroke's next edit, or a new stroke's first one.
class RandomEdits {
  public:
    explicit RandomEdits(const HapticScene& scene) : scene_(scene) {}
    SculptEntry next() {
        const auto choice = random_() % 40;
        if (choice < 4 || !begun_) {
            begun_ = true;
            stroke_ = {.object = static_cast<int32_t>(random_() % scene_.objects.size())};
            constexpr SculptTool kTools[]{SculptTool::Carve, SculptTool::Add, SculptTool::Carve,
                                          SculptTool::Add, SculptTool::Smooth};
            stroke_.tool = kTools[random_() % std::size(kTools)];
            const Similarity& at = object().workspaceFromObject;
            stroke_.radius = number(0.009, 0.014) / at.scale;
            stroke_.centre = object().boundingRadius * glm::dvec3(number(0.6, 0.9), number(-0.3, 0.3), 0.0);
            return {.kind = SculptEntryKind::Begin, .object = stroke_.object};
        }
        if (choice == 4)
            return {.kind = SculptEntryKind::Undo};
        if (choice == 5)
            return {.kind = SculptEntryKind::Redo};
        stroke_.centre +=
            stroke_.radius * glm::dvec3(number(-0.1, 0.1), number(-0.1, 0.3), number(-0.1, 0.1));
        SculptEntry dab = stroke_;
        if (choice == 6)
            dab.radius = -1.0; // refused
        return dab;
    }
    [[nodiscard]] std::chrono::milliseconds pause() {
        return std::chrono::milliseconds(random_() % 4 == 0 ? random_() % 20 : random_() % 3);
    }

  private:
    [[nodiscard]] const HapticObject& object() const {
        return *scene_.objects[static_cast<size_t>(stroke_.object)];
    }
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    const HapticScene& scene_;
    std::mt19937 random_{11};
    SculptEntry stroke_;
    bool begun_ = false;
};

TEST(LiveEdits, ArePublishedAsTheirJournalSaysWhateverMeetsWhat) {
    const TouchedScene scene = twoTori();
    ASSERT_EQ(scene.haptic->objects.size(), 2u);
    const TouchedScene stiffer =
        withChanged(scene, [](HapticMaterial& material) { material.stiffness.value = 250.0f; });
    RubbingDevice device{{0.0, 0.0, 1.0}};
    Session session{{portOf(device)}, RecordedServo::kQuick};
    JournalFollower follower;
    session.subscribe(follower);
    (void)session.touch(scene.haptic, scene.source, scene.identity);
    session.start();
    RandomEdits edits(*scene.haptic);
    using Kind = SculptEntryKind;
    constexpr std::array kAlways{Kind::Begin, Kind::Undo, Kind::Redo, Kind::Dab};
    constexpr std::array kOfPieces{Kind::Shape, Kind::Preview, Kind::Restore};
    const auto misses = [&](const auto& kinds) {
        return std::ranges::any_of(kinds, [&](Kind kind) { return follower.kinds[kind] == 0; });
    };
    const auto inPieces = [&] { // a dab that takes no longer than kWhole is made in one
        return session.sculptor().figures().longestDab > 2.0 * LiveSculptor::kWhole;
    };
    for (int i = 0; i < 2000 && (i < 200 || misses(kAlways) || (inPieces() && misses(kOfPieces))); ++i) {
        session.sculptor().add(edits.next());
        std::this_thread::sleep_for(edits.pause());
        session.pump(0.0);
        if (i % 50 == 40) { // other materials, where edits wait and previews are felt
            const TouchedScene& other = i % 100 == 40 ? stiffer : scene;
            (void)session.touch(other.haptic, other.source, other.identity, SceneSwap::SameGeometry, true);
        }
    }
    endSculpting(session);
    EXPECT_EQ(follower.others, 0u) << "of " << follower.published;
    EXPECT_GT(follower.published, 10u);
    for (const Kind kind : kAlways)
        EXPECT_GT(follower.kinds[kind], 0u) << static_cast<int>(kind);
    if (inPieces()) {
        for (const Kind kind : kOfPieces)
            EXPECT_GT(follower.kinds[kind], 0u) << static_cast<int>(kind);
    }
    // Everything taken back.
    while (session.sculptor().figures().undoSteps > 0) {
        session.sculptor().undo();
        session.sculptor().drain();
        session.pump(0.0);
    }
    EXPECT_EQ(follower.others, 0u);
    for (size_t k = 0; k < scene.haptic->objects.size(); ++k)
        EXPECT_EQ(fieldOfObject(*follower.sculptor->scene(), k), fieldOfObject(*scene.haptic, k))
            << "the very grid";
}

} // namespace
} // namespace touchstone::test
