// Soft bodies under edits of their materials: they go on, and the replay says the same.
#include "haptics/settings/tick_flags.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test::soft_replay_test {
namespace {

class SoftReplay : public testing::Test {
  protected:
    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
};

/// From 10 mm above the top of jelly.glb or cloth.glb to `depth` below it, in half a second.
RecordedServo::Hand pressing(const TouchedScene& scene, double top, double depth) {
    return [=, workspaceFromScene = scene.haptic->workspaceFromScene](double time) {
        const double below = std::min(time / 0.5, 1.0) * (0.010 + depth) - 0.010;
        return at(workspaceFromScene.point({0.001, top - below, 0.0015}));
    };
}

TEST_F(SoftReplay, EditsOfAMaterialLeaveThemWhereTheyAre) {
    for (const auto& [file, top, depth] :
         {std::tuple("jelly.glb", 0.040, 0.006), std::tuple("cloth.glb", 0.020, 0.004)}) {
        TouchedScene scene = touchedScene(file);
        RecordedServo rig(pressing(scene, top, depth));
        rig.recorder.start(file_, "test");
        rig.offer(scene);
        rig.ticks(3200);
        const size_t first = rig.records.size();
        ASSERT_GT(rig.records.back().output.contacts, 0u) << file;
        std::mt19937 random(5);
        for (int i = 0; i < 40; ++i) {
            scene = withChanged(scene, [&](HapticMaterial& haptic) {
                haptic.stiffness.value = 400.0f + 10.0f * static_cast<float>(random() % 60u);
                haptic.staticFriction.value = 0.01f * static_cast<float>(random() % 60u);
                haptic.dynamicFriction.value = haptic.staticFriction.value;
                haptic.forceShading = i % 5 == 0 ? ShadingChoice::Off : ShadingChoice::Auto;
            });
            rig.offer(scene, SceneSwap::SameGeometry);
            rig.ticks(static_cast<uint64_t>(40 + random() % 60u));
        }
        rig.finish();
        double farthest = 0.0;
        size_t touching = 0, lost = 0;
        for (size_t k = first; k < rig.records.size(); ++k) {
            const TickRecord &now = rig.records[k], &before = rig.records[k - 1];
            touching += now.output.contacts > 0 ? 1 : 0;
            lost += has(now.output.flags, TickFlag::StartedInside) ? 1 : 0;
            farthest = std::max(farthest, glm::distance(now.output.proxy, before.output.proxy) /
                                              static_cast<double>(now.tick - before.tick));
        }
        std::printf("%s: %zu of %zu ticks in contact, the proxy moves by at most %.3f mm a tick\n", file,
                    touching, rig.records.size() - first, 1e3 * farthest);
        EXPECT_EQ(lost, 0u) << file;
        EXPECT_GT(10 * touching, 9 * (rig.records.size() - first)) << file;
        EXPECT_LT(farthest, 1e-3) << "it began anew";
        EXPECT_EQ(rig.countOf(TickFlag::Jammed), 0u);
        const ReplayReport report = replayOf(file_, rig.scenes);
        expectEqualReplay(report);
        EXPECT_EQ(report.ticks, rig.servo.counters().ticks);
        rig.expectWithinLimits();
    }
}

} // namespace
} // namespace touchstone::test::soft_replay_test
