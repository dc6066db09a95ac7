// Journals of sculpting: what is read, what is refused, and what they make of a scene.

#include "engine/core/error.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/scene/scene_sculptor.h"
#include "haptics/shape/field/save/field_export.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace touchstone::test::sculpt_journal_test {
namespace {

SculptStep carve(const glm::dvec3& at, double radius) {
    SculptStep step;
    step.radius = radius;
    step.points = {at};
    return step;
}

TEST(SculptJournal, ReadsBackWhatItWrites) {
    std::vector<SculptStep> steps{carve({0.1, -0.2, 0.3}, 0.01)};
    steps[0].object = "head";
    for (const SculptToolInfo& info : sculptTools()) {
        SculptStep step = carve({0.0, 0.1, 1e-7}, 0.003);
        step.tool = info.tool;
        step.strength = 0.1 + 0.1 * static_cast<double>(steps.size());
        step.falloff = 1.0 / 3.0;
        step.points.emplace_back(1.0, 2.0, 3.0);
        if (info.tool == SculptTool::Stamp || info.tool == SculptTool::Imprint)
            step.stamp = "star \"A\"";
        step.time = 0.5 * static_cast<double>(steps.size());
        steps.push_back(step);
    }
    SculptStep undo;
    undo.action = SculptAction::Undo;
    undo.time = 9.0;
    steps.push_back(undo);
    undo.action = SculptAction::Redo;
    steps.push_back(undo);
    steps[0].time = 0.0;
    EXPECT_EQ(sculptJournalOf(sculptJournalText(steps), "journal"), steps);
}

TEST(SculptJournal, RefusesWhatIsNoJournalAndNamesTheStroke) {
    for (const char* text :
         {"", "{", R"({"sculpt": 1, "strokes": [{"tool": "carve", "radius": 1e999}]})", "[]", "{}",
          R"({"sculpt": 2, "strokes": []})", R"({"sculpt": 1, "strokes": {}})"})
        EXPECT_THROW((void)sculptJournalOf(text, "j"), Error) << text;
    for (const char* stroke : {"1",
                               "{}",
                               R"({"tool": "chisel"})",
                               R"({"tool": 3})",
                               R"({"tool": "carve"})",
                               R"({"tool": "carve", "radius": 0.1})",
                               R"({"tool": "carve", "radius": 0.1, "points": []})",
                               R"({"tool": "carve", "radius": 0.1, "points": [[0, 0]]})",
                               R"({"tool": "carve", "radius": 0.1, "points": [[0, 0, "x"]]})",
                               R"({"tool": "carve", "radius": 0.1, "points": [[0, 0, 1e300]]})",
                               R"({"tool": "carve", "radius": 0, "points": [[0, 0, 0]]})",
                               R"({"tool": "carve", "radius": -1, "points": [[0, 0, 0]]})",
                               R"({"tool": "carve", "radius": 1, "strength": 0, "points": [[0, 0, 0]]})",
                               R"({"tool": "carve", "radius": 1, "strength": 2, "points": [[0, 0, 0]]})",
                               R"({"tool": "carve", "radius": 1, "falloff": null, "points": [[0, 0, 0]]})",
                               R"({"tool": "carve", "radius": 1, "points": [[0, 0, 0]], "stamp": "a"})",
                               R"({"tool": "carve", "radius": 1, "points": [[0, 0, 0]], "colour": 1})",
                               R"({"tool": "carve", "radius": 1, "points": [[0, 0, 0]], "time": -1})",
                               R"({"tool": "stamp", "radius": 1, "points": [[0, 0, 0]]})",
                               R"({"tool": "undo", "radius": 1})"}) {
        const std::string good = R"({"tool": "undo"})";
        try {
            (void)sculptJournalOf(R"({"sculpt": 1, "strokes": [)" + good + "," + stroke + "]}", "j.json");
            ADD_FAILURE() << stroke;
        } catch (const Error& error) {
            EXPECT_EQ(error.place(), "strokes[1]") << stroke;
            EXPECT_EQ(error.file(), "j.json");
        }
    }
    EXPECT_THROW(
        (void)sculptJournalOf(
            R"({"sculpt": 1, "strokes": [{"tool": "undo", "time": 2}, {"tool": "undo", "time": 1}]})", "j"),
        Error);
}

/// A tunnel along the axis of a ball's field, in a scene that is 150 mm large and off the origin.
TEST(SceneSculptor, CarvesATunnelWhereTheJournalSaysAndItIsFelt) {
    constexpr double kScale = 0.15, kRadius = 0.006;
    const FieldBench bench(fieldOf(ball, 96), kScale);
    SceneSculptor sculptor(bench.scene);
    const glm::dvec3 middle = FieldBench::kMiddle;
    SculptStep tunnel = carve(middle - glm::dvec3(0.08, 0, 0), kRadius);
    tunnel.points.push_back(middle + glm::dvec3(0.08, 0, 0));
    const uint64_t hash = sculptor.hash();
    const SculptReport report = sculptor.apply(tunnel);
    // A cylinder through a ball (the napkin ring): 4/3 pi (R^3 - (R^2 - r^2)^1.5).
    const double outer = 0.4 * kScale;
    const double volume = 4.0 / 3.0 * std::numbers::pi *
                          (std::pow(outer, 3.0) - std::pow(outer * outer - kRadius * kRadius, 1.5));
    std::printf("tunnel %.1f of %.1f mm^3, %zu dabs\n", 1e9 * report.removed, 1e9 * volume, report.dabs);
    EXPECT_NEAR(report.removed, volume, 0.02 * volume);
    EXPECT_NE(sculptor.hash(), hash);
    EXPECT_TRUE(sculptor.scene() != bench.scene);
    // A hand flies through it without a force, and stands on its wall.
    FieldBench felt(fieldOf(ball, 96), kScale);
    felt.scene = sculptor.scene();
    double most = 0.0;
    for (int i = 0; i <= 600; ++i)
        most = std::max(most, glm::length(felt.step(middle + glm::dvec3(-0.09 + 3e-4 * i, 0.0, 0.0)).force));
    EXPECT_EQ(most, 0.0);
    FieldBench wall(fieldOf(ball, 96), kScale);
    wall.scene = sculptor.scene();
    wall.step(middle + glm::dvec3(-0.09, 0, 0));
    wall.moveTo(middle, 0.2);
    wall.moveTo(middle - glm::dvec3(0, kRadius + 0.002, 0), 0.05);
    const HapticOutput& out = wall.step(middle - glm::dvec3(0, kRadius + 0.002, 0));
    EXPECT_NEAR(out.proxy.y, middle.y - kRadius, 0.5 * 1.2 / 96 * kScale);
    EXPECT_GT(out.force.y, 0.5);
    SculptStep undo;
    undo.action = SculptAction::Undo;
    EXPECT_EQ(sculptor.apply(undo).removed, -report.removed);
    EXPECT_EQ(sculptor.hash(), hash);
}

TEST(SceneSculptor, RefusesUnknownObjectsMeshesAndEndlessStrokesBeforeAnythingChanges) {
    const FieldBench bench(fieldOf(ball, 48));
    SceneSculptor sculptor(bench.scene);
    const auto refused = [&](const auto& spoil) {
        SculptStep step = carve(FieldBench::kMiddle + glm::dvec3(0.06, 0.0, 0.0), 0.01);
        spoil(step);
        EXPECT_THROW(sculptor.apply(step), Error);
        EXPECT_TRUE(sculptor.scene() == bench.scene);
    };
    refused([](SculptStep& s) { s.object = "nothing"; });
    refused([](SculptStep& s) { s.radius = 1e6; });
    refused([](SculptStep& s) {
        s.radius = 1e-5;
        s.points.emplace_back(1e6, 0.0, 0.0);
    });
    refused([](SculptStep& s) {
        s.tool = SculptTool::Stamp;
        s.stamp = "nothing";
    });
}

TEST(SceneSculptor, RefusesAMesh) {
    const TouchBench bench(cornerScene({{.normal = {0, 1, 0}, .stiffness = 600.0}}), cornerSettings());
    SceneSculptor sculptor(bench.scene);
    EXPECT_THROW(sculptor.apply(carve(glm::dvec3(0.0), 0.01)), Error);
}

/// The field changes while a hand presses on it: every force stays within the limits, a hole lets go, a rise
/// of half a voxel lifts the proxy onto it, and a mass that buries the hand is felt once the hand has left
/// it.
TEST(SceneSculptor, ChangesWhatIsTouchedWithoutAForceBeyondTheSpring) {
    constexpr double kScale = 0.15, kVoxel = 1.2 / 96 * kScale, kTop = 0.4 * kScale;
    const glm::dvec3 up(0.0, 1.0, 0.0), middle = FieldBench::kMiddle;
    FieldBench bench(fieldOf(ball, 96), kScale);
    SceneSculptor sculptor(bench.scene);
    const auto sculpt = [&](SculptTool tool, double height, double radius) {
        SculptStep step = carve(middle + height * up, radius);
        step.tool = tool;
        sculptor.apply(step);
        bench.scene = sculptor.scene();
        takeUpReshaped(*bench.scene, bench.scene->restMotions, sculptor.sculpted(), bench.state[0]);
    };
    const glm::dvec3 pressed = middle + (kTop - 0.003) * up;
    bench.step(middle + (kTop + 0.02) * up);
    bench.moveTo(pressed, 0.1);
    for (int i = 0; i < 50; ++i)
        bench.step(pressed);
    EXPECT_NEAR(bench.output.penetration, 0.003, 0.1 * kVoxel);
    // A dome whose top stands half a voxel above the ball.
    sculpt(SculptTool::Add, kTop - 0.02 + 0.5 * kVoxel, 0.02);
    for (int i = 0; i < 50; ++i)
        bench.step(pressed);
    EXPECT_NEAR(bench.output.penetration, 0.003 + 0.5 * kVoxel, 0.2 * kVoxel);
    EXPECT_NEAR(glm::length(bench.output.force), 600.0 * bench.output.penetration, 0.1);
    // A hole below the hand.
    sculpt(SculptTool::Carve, kTop, 0.012);
    bench.step(pressed);
    EXPECT_EQ(bench.output.contacts, 0u);
    EXPECT_EQ(glm::length(bench.output.force), 0.0);
    // Filled again: the hand is inside, and feels nothing until it has left.
    sculpt(SculptTool::Add, kTop, 0.012);
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(glm::length(bench.step(pressed).force), 0.0);
    bench.moveTo(middle + (kTop + 0.04) * up, 0.2);
    bench.moveTo(middle + (kTop + 0.009) * up, 0.1);
    EXPECT_NEAR(bench.output.penetration, 0.003, 0.2 * kVoxel);
}

/// What is saved lies where it is felt.
TEST(FieldExport, TheMeshLiesOnTheSurfaceWithNormalsOutwards) {
    Sculptor sculptor(std::make_shared<FieldGrid>(gridOfDistance(cubeOf(96), 0.2, 0.1, ball)));
    Dab dab;
    dab.centre = {0.4, 0.0, 0.0};
    dab.radius = 0.15;
    sculptor.apply(dab);
    const Similarity scene{2.0, {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0}, {1.0, 2.0, 3.0}};
    const SurfaceMesh mesh = meshOfField(sculptor.grid(), scene);
    const FieldShape shape(sculptor.grid());
    double worst = 0.0;
    size_t turned = 0;
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        worst = std::max(worst, std::abs(shape.value(scene.inversePoint(glm::dvec3(mesh.positions[i])))));
    for (size_t i = 0; i < mesh.corners.size(); i += 3) {
        const glm::vec3 &a = mesh.positions[mesh.corners[i]], &b = mesh.positions[mesh.corners[i + 1]],
                        &c = mesh.positions[mesh.corners[i + 2]];
        turned += glm::dot(glm::cross(b - a, c - a), mesh.normals[mesh.corners[i]]) < 0.0f ? 1 : 0;
    }
    std::printf("%zu triangles, worst %.4f voxels, %zu turned\n", mesh.corners.size() / 3,
                worst / cubeOf(96).voxel, turned);
    EXPECT_GT(mesh.corners.size(), 3000u);
    EXPECT_LT(worst, 1e-4 * cubeOf(96).voxel);
    EXPECT_EQ(turned, 0u);
    // The same field gives the same mesh.
    EXPECT_EQ(meshOfField(sculptor.grid(), scene).positions, mesh.positions);
}

} // namespace
} // namespace touchstone::test::sculpt_journal_test
