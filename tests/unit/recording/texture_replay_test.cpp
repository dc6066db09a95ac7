// Persistent textures in recordings: a replay makes the same texture, from the start, from the middle and
// behind a gap, and a recording of brushing stays small.

#include "engine/program/surface_program.h"
#include "haptics/scene/scene_programs.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "tests/support/test_shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <variant>

namespace touchstone::test::texture_replay_test {
namespace {

/// A square of 0.1 m under plaque, facing +z.
TouchedScene plaqueScene(int side) {
    const nlohmann::json shader{{"source", "plaque.glsl"},
                                {"persistentTexture", {{"width", side}, {"height", side}}}};
    auto source = std::make_shared<Scene>();
    source->path = "plaque";
    source->materials.emplace_back();
    place(*source, quadMesh(0.05, 4), 0);
    const auto compiled = compileSurfaceProgram(
        "plaque.glsl",
        "void touch(const in Touch before, inout Surface after) {\n"
        "after.staticFriction = mix(0.1, 0.6, before.persistent);\n"
        "after.dynamicFriction = mix(0.05, 0.5, before.persistent);\n"
        "after.persistentChange = -1e-4 * length(before.force); after.brush = 0.004;\n}\n",
        {}, [] { return false; });
    source->materials[0].haptic.program = materialProgram(compiled, shader);
    TouchedScene scene{source, compileHapticScene(*source, Similarity{}), {}};
    scene.identity = identify(*scene.haptic, *source, Fit::None);
    return scene;
}

/// To and fro, 1 mm deep, in from above.
DeviceSample brushing(double time) {
    const double depth = 0.001 - 0.01 * std::exp(-20.0 * time);
    return at({0.03 * std::sin(3.0 * time), 0.03 * std::sin(2.1 * time), -depth});
}

class TextureReplay : public testing::Test {
  protected:
    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";

    /// The texture of the run, by its strokes.
    static std::vector<float> valuesOf(const PersistentTextures& textures) {
        const std::span<const float> values = textures.at(0)->values();
        return {values.begin(), values.end()};
    }
};

TEST_F(TextureReplay, MeetsTextureAndForceToTheLastBit) {
    RecordedServo rig(brushing);
    rig.recorder.start(file_, "test");
    rig.offer(plaqueScene(256));
    rig.steps(8000);
    ASSERT_NE(rig.recorder.textures(), nullptr);
    EXPECT_LT(rig.recorder.textures()->at(0)->mean(), 0.99) << "it was brushed";
    rig.finish();
    expectEqualReplay(replayOf(file_, rig.scenes));
    EXPECT_GT(rig.inContact(), 6000u);
}

TEST_F(TextureReplay, BeginsInTheMiddleAndGoesOnBehindAGap) {
    RecordedServo rig(brushing);
    rig.offer(plaqueScene(128));
    rig.steps(5000);
    rig.recorder.start(file_, "test"); // an eaten texture, whole in the file
    rig.steps(9000);
    rig.finish();
    const std::vector<RecordedItem> items = itemsOf(file_);
    const auto whole = std::ranges::count_if(
        items, [](const RecordedItem& item) { return std::holds_alternative<RecordedTextures>(item); });
    ASSERT_GE(whole, 1);
    expectEqualReplay(replayOf(file_, rig.scenes));
    // Without its second block of ticks: it goes on at the next checkpoint, with the texture as it was there.
    std::vector<RecordedItem> torn;
    size_t blocks = 0;
    for (const RecordedItem& item : items) {
        if (std::holds_alternative<RecordedTicks>(item) && ++blocks == 2) {
            torn.emplace_back(RecordedLoss{256});
            continue;
        }
        torn.push_back(item);
    }
    const std::filesystem::path cut = scratch_ / "cut.tsrec";
    writeItems(cut, torn);
    const ReplayReport report = replayOf(cut, rig.scenes);
    EXPECT_EQ(report.differing, 0u);
    EXPECT_FALSE(report.first.has_value());
    EXPECT_GT(report.replayed, 3000u);
    EXPECT_EQ(report.gaps, 1u);
}

TEST_F(TextureReplay, AChangedStrokeIsNamed) {
    RecordedServo rig(brushing);
    rig.recorder.start(file_, "test");
    rig.offer(plaqueScene(64));
    rig.steps(3000);
    rig.finish();
    std::vector<RecordedItem> items = itemsOf(file_);
    for (RecordedItem& item : items)
        if (auto* const strokes = std::get_if<RecordedStrokes>(&item)) {
            strokes->strokes.back().change *= 1.5;
            break;
        }
    writeItems(scratch_ / "changed.tsrec", items);
    const ReplayReport report = replayOf(scratch_ / "changed.tsrec", rig.scenes);
    ASSERT_TRUE(report.first.has_value());
    EXPECT_EQ(report.first->stage, "textures");
    EXPECT_EQ(report.differing, 1u);
}

TEST_F(TextureReplay, EditsOfTheMaterialLeaveTheTexture) {
    const TouchedScene scene = plaqueScene(64);
    RecordedServo rig(brushing);
    rig.recorder.start(file_, "test");
    rig.offer(scene);
    rig.steps(4000);
    const double before = rig.recorder.textures()->at(0)->mean();
    rig.offer(withChanged(scene, [](HapticMaterial& material) { material.stiffness.value = 600.0f; }),
              SceneSwap::SameGeometry);
    rig.steps(4000);
    EXPECT_LT(rig.recorder.textures()->at(0)->mean(), before);
    rig.finish();
    expectEqualReplay(replayOf(file_, rig.scenes));
}

TEST_F(TextureReplay, BrushingALargeTextureTakesLessThanAMegabyteASecond) {
    ServoConfig config = RecordedServo::kQuick;
    config.rateHz = 1000.0;
    RecordedServo rig(brushing, config);
    rig.recorder.start(file_, "test");
    rig.offer(plaqueScene(1024));
    rig.steps(6000);
    rig.finish();
    const double seconds = static_cast<double>(rig.records.size()) / 1000.0;
    const double rate = static_cast<double>(std::filesystem::file_size(file_)) / seconds;
    std::printf("[ recording] 1024^2 while brushing at 1 kHz: %.0f kB/s\n", 1e-3 * rate);
    EXPECT_LT(rate, 1e6);
    EXPECT_GT(rig.inContact(), 4000u);
}

} // namespace
} // namespace touchstone::test::texture_replay_test
