// Colours on the journal of sculpting: what a dab makes, what undo brings back, and what is saved.

#include "engine/core/error.h"
#include "haptics/recording/recording_format.h"
#include "haptics/scene/scene_sculptor.h"
#include "haptics/servo/tool_path.h"
#include "haptics/shape/field/field_colors.h"
#include "haptics/shape/field/save/field_blocks.h"
#include "haptics/shape/field/save/field_export.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace touchstone::test::painting_test {
namespace {

constexpr int kCells = 48;
constexpr double kVoxel = 1.2 / kCells;
const glm::vec3 kRed(0.9f, 0.1f, 0.05f), kBlue(0.0f, 0.2f, 1.0f), kWhite(1.0f);

std::shared_ptr<const FieldGrid> ballGrid() {
    return gridOf(ball, kCells);
}

Dab paintAt(const glm::dvec3& centre, double radius, const glm::vec3& color) {
    Dab dab;
    dab.tool = SculptTool::Paint;
    dab.centre = centre;
    dab.radius = radius;
    dab.color = color;
    return dab;
}

glm::vec3 colorAt(Sculptor& sculptor, const glm::ivec3& node) {
    return sculptor.colors() != nullptr ? sculptor.colors()->node(node) : kWhite;
}

template <class Visit>
void eachNode(const Visit& visit) {
    for (int z = 0; z <= kCells; ++z)
        for (int y = 0; y <= kCells; ++y)
            for (int x = 0; x <= kCells; ++x)
                visit(glm::ivec3(x, y, z), glm::dvec3(-0.6) + kVoxel * glm::dvec3(x, y, z));
}

/// c + s w (p - c) at every node within two voxels of the surface, and nowhere else; a second dab goes on
/// from the first.
TEST(Painting, MixesTheColourInByStrengthAndFalloff) {
    Sculptor sculptor(ballGrid());
    Dab first = paintAt({0.0, 0.4, 0.0}, 0.15, kRed), second = paintAt({0.05, 0.4, 0.0}, 0.1, kBlue);
    first.strength = 0.7;
    first.falloff = 0.5;
    second.strength = 0.25;
    EXPECT_GT(sculptor.apply(first).bricks, 0u);
    EXPECT_GT(sculptor.apply(second).bricks, 0u);
    int painted = 0, deep = 0;
    eachNode([&](const glm::ivec3& node, const glm::dvec3& place) {
        glm::dvec3 expected(1.0);
        const double rho = glm::distance(place, first.centre) / first.radius;
        const bool near = std::abs(sculptor.base()->node(node)) < 2.0 * kVoxel;
        if (near && rho <= 1.0) {
            const double t = std::min((1.0 - rho) / 0.5, 1.0); // a smooth step over the outer half
            expected = glm::mix(expected, glm::dvec3(kRed), 0.7 * t * t * (3.0 - 2.0 * t));
        }
        if (near && glm::distance(place, second.centre) / second.radius <= 1.0)
            expected = glm::mix(expected, glm::dvec3(kBlue), 0.25);
        const glm::vec3 color = colorAt(sculptor, node);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(color[k], expected[k], 1e-6);
        painted += color != kWhite ? 1 : 0;
        deep += !near && rho < 0.9 ? 1 : 0;
    });
    EXPECT_GT(painted, 300);
    EXPECT_GT(deep, 100) << "within the ball, but away from the surface";
    EXPECT_EQ(sculptor.grid(), sculptor.base()) << "nothing is carved";
}

/// Trilinear between nodes, all of which around the surface are painted: a whole stroke has one colour.
TEST(Painting, ColoursTheWholeSurfaceWithinTheBall) {
    Sculptor sculptor(ballGrid());
    sculptor.apply(paintAt({0.0, 0.0, 0.4}, 0.2, kBlue));
    const auto colors = sculptor.colors();
    ASSERT_NE(colors, nullptr);
    for (double angle = 0.0; angle < 6.28; angle += 0.1)
        for (double away = 0.0; away < 0.2; away += 0.01) {
            const double tilt = 2.0 * std::asin(away / 0.8); // a chord of the ball of 0.4
            const glm::dvec3 place = 0.4 * glm::dvec3(std::sin(tilt) * std::cos(angle),
                                                      std::sin(tilt) * std::sin(angle), std::cos(tilt));
            const glm::vec3 color = colors->at(place);
            if (away < 0.2 - 2.0 * kVoxel) {
                EXPECT_LT(glm::length(color - kBlue), 1e-6f) << away;
            }
        }
    EXPECT_EQ(colors->at({0.0, 0.0, -0.4}), kWhite);
    EXPECT_EQ(colors->at({50.0, 0.0, 0.0}), kWhite) << "outside of the grid";
}

TEST(Painting, UndoBringsTheWhiteBackAndRedoTheSameColours) {
    Sculptor sculptor(ballGrid());
    std::vector<uint64_t> hashes;
    for (int i = 0; i < 20; ++i) {
        sculptor.beginStroke();
        const glm::dvec3 place = 0.4 * glm::dvec3(std::cos(0.3 * i), std::sin(0.3 * i), 0.0);
        if (i % 3 == 2) { // carving goes on the same history
            Dab carve = paintAt(place, 0.08, kRed);
            carve.tool = SculptTool::Carve;
            sculptor.apply(carve);
        } else {
            Dab dab = paintAt(place, 0.1, i % 2 == 0 ? kRed : kBlue);
            dab.strength = 0.6;
            sculptor.apply(dab);
        }
        hashes.push_back(sculptor.colors()->hash() ^ sculptor.grid()->hash());
    }
    EXPECT_EQ(sculptor.undoSteps(), 20u);
    for (int i = 18; i >= 0; --i) {
        EXPECT_TRUE(sculptor.undo());
        EXPECT_EQ(sculptor.colors()->hash() ^ sculptor.grid()->hash(), hashes[static_cast<size_t>(i)]) << i;
    }
    EXPECT_TRUE(sculptor.undo());
    EXPECT_EQ(sculptor.colors(), nullptr);
    EXPECT_EQ(sculptor.grid(), sculptor.base());
    EXPECT_FALSE(sculptor.undo());
    for (int i = 0; i < 20; ++i)
        EXPECT_TRUE(sculptor.redo());
    EXPECT_EQ(sculptor.colors()->hash() ^ sculptor.grid()->hash(), hashes.back());
    EXPECT_GT(sculptor.memoryBytes(), 20 * sizeof(ColorBrick));
}

/// White takes colour off: what is all white again is as if it had never been painted.
TEST(Painting, WhiteTakesItOff) {
    Sculptor sculptor(ballGrid());
    sculptor.apply(paintAt({0.4, 0.0, 0.0}, 0.1, kRed));
    EXPECT_FALSE(sculptor.takeChangedBricks().empty()) << "for the eye";
    sculptor.apply(paintAt({0.4, 0.0, 0.0}, 0.12, kWhite));
    EXPECT_EQ(sculptor.colors(), nullptr);
    EXPECT_EQ(sculptor.apply(paintAt({0.4, 0.0, 0.0}, 0.12, kWhite)).bricks, 0u);
    EXPECT_EQ(sculptor.apply(paintAt({5.0, 0.0, 0.0}, 0.12, kRed)).bricks, 0u) << "outside of the grid";
}

/// What is carved free was inside of the solid and has no colour; the rest keeps its own.
TEST(Painting, WhatIsCarvedFreeIsWhite) {
    Sculptor sculptor(ballGrid());
    sculptor.apply(paintAt({0.0, 0.4, 0.0}, 0.3, kRed));
    Dab carve = paintAt({0.0, 0.4, 0.0}, 0.15, kRed);
    carve.tool = SculptTool::Carve;
    sculptor.apply(carve);
    EXPECT_EQ(sculptor.colors()->at({0.0, 0.25, 0.0}), kWhite);
    const double tilt = 2.0 * std::asin(0.22 / 0.8);
    EXPECT_LT(glm::length(sculptor.colors()->at({0.4 * std::sin(tilt), 0.4 * std::cos(tilt), 0.0}) - kRed),
              1e-6f);
}

TEST(Painting, RefusesColoursThatCannotBe) {
    Sculptor sculptor(ballGrid());
    for (const glm::vec3& color :
         {glm::vec3(1.1f, 0.0f, 0.0f), glm::vec3(0.0f, -0.1f, 0.0f), glm::vec3(0.0f, 0.0f, NAN)})
        EXPECT_THROW(sculptor.apply(paintAt({0.4, 0.0, 0.0}, 0.1, color)), Error);
    EXPECT_THROW(sculptor.apply(paintAt({0.4, 0.0, 0.0}, 0.0, kRed)), Error);
    EXPECT_EQ(sculptor.colors(), nullptr);
    EXPECT_EQ(sculptor.undoSteps(), 0u);
}

/// Vertices have the colour where they lie, in what is saved and in the blocks that the eye sees.
TEST(Painting, TheMeshHasTheColours) {
    Sculptor sculptor(ballGrid());
    const Similarity place{0.15, {1, 0, 0, 0}, {0.0, 0.5, 0.0}};
    EXPECT_TRUE(meshOfField(sculptor.grid(), place, sculptor.colors().get()).colors.empty());
    FieldBlocks blocks;
    (void)blocks.update(sculptor.grid(), {}, sculptor.colors().get());
    sculptor.apply(paintAt({0.0, 0.4, 0.0}, 0.2, kRed));
    EXPECT_GT(blocks.update(sculptor.grid(), sculptor.takeChangedBricks(), sculptor.colors().get()), 0u);
    const SurfaceMesh mesh = meshOfField(sculptor.grid(), place, sculptor.colors().get());
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    int red = 0, white = 0;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 at = place.inversePoint(glm::dvec3(mesh.positions[i]));
        const double away = glm::distance(at, glm::dvec3(0.0, 0.4, 0.0));
        if (away < 0.2 - 2.0 * kVoxel) {
            EXPECT_LT(glm::length(glm::vec3(mesh.colors[i]) - kRed), 1e-5f);
            ++red;
        } else if (away > 0.2 + 2.0 * kVoxel) {
            EXPECT_LT(glm::length(glm::vec3(mesh.colors[i]) - kWhite), 1e-5f);
            ++white;
        }
    }
    EXPECT_GT(red, 100);
    EXPECT_GT(white, 1000);
    size_t colored = 0;
    for (const auto& [number, block] : blocks.blocks())
        for (size_t i = 0; i < block.colors.size(); ++i) {
            EXPECT_LT(glm::length(block.colors[i] - sculptor.colors()->at(glm::dvec3(block.positions[i]))),
                      1e-4f);
            colored += block.colors[i] != kWhite ? 1 : 0;
        }
    EXPECT_GT(colored, 100u);
}

/// The journal's strokes and the entries of a recording lead to the same colours; nothing that is felt
/// differs.
TEST(Painting, EntriesOfAJournalPaintTheSameAndNothingElse) {
    const FieldBench bench(fieldOf(ball, 64));
    SceneSculptor sculptor(bench.scene), again(bench.scene);
    const uint64_t before = sculptor.hash();
    SculptStep step;
    step.tool = SculptTool::Paint;
    step.radius = 0.01;
    step.color = kRed;
    step.points = {FieldBench::kMiddle + glm::dvec3(0.0, 0.06, 0.0),
                   FieldBench::kMiddle + glm::dvec3(0.06, 0.0, 0.0)};
    const SculptReport report = sculptor.apply(step);
    EXPECT_EQ(report.removed, 0.0);
    EXPECT_GT(report.bricks, 0u);
    EXPECT_NE(sculptor.hash(), before);
    const auto object = static_cast<size_t>(sculptor.sculpted().front());
    EXPECT_EQ(fieldOfObject(*sculptor.scene(), object), fieldOfObject(*bench.scene, object));
    for (const SculptEntry& entry : sculptor.takeEntries())
        (void)again.apply(entry);
    again.settle();
    EXPECT_EQ(again.hash(), sculptor.hash());
    step.action = SculptAction::Undo;
    sculptor.apply(step);
    EXPECT_EQ(sculptor.hash(), before);
    EXPECT_EQ(colorsOfObject(*sculptor.scene(), object), nullptr);
}

/// A journal without paint has the bytes that it had before there was paint.
TEST(Painting, ARecordingHoldsTheColour) {
    const SculptEntry carve{.kind = SculptEntryKind::Dab, .object = 2, .radius = 0.1};
    SculptEntry paint = carve;
    paint.tool = SculptTool::Paint;
    paint.color = kBlue;
    const RecordedSculpt sculpt{7, 3, 0x55, 0, {carve, paint, carve}};
    const std::vector<std::byte> bytes = encode(sculpt);
    EXPECT_EQ(bytes.size(), 24u + 3 * kSculptEntrySize + kPaintSize);
    EXPECT_EQ(std::get<RecordedSculpt>(decode(11, bytes)).entries, sculpt.entries);
    const LiveTool tool{.active = true, .tool = SculptTool::Paint, .color = kRed};
    EXPECT_EQ(std::get<RecordedTool>(decode(10, encode(RecordedTool{tool}))).tool, tool);
    std::vector<std::byte> cut = bytes;
    cut.resize(cut.size() - 5);
    EXPECT_THROW((void)decode(11, cut), Error);
}

TEST(Painting, AHandPaintsWhereItTouchesAndNotWhereItRests) {
    FieldBench bench{fieldOf(ball, 96), 0.15};
    ToolPath path;
    const LiveTool tool{.active = true,
                        .tool = SculptTool::Paint,
                        .object = 1,
                        .radius = 0.008,
                        .strength = 0.5,
                        .color = kBlue};
    HapticOutput output;
    uint64_t tick = 0;
    const auto at = [&](const glm::dvec3& place, bool touches) {
        output.proxy = FieldBench::kMiddle + place;
        output.hip = output.proxy - glm::dvec3(0.0, 0.002, 0.0);
        output.contacts = touches ? 1 : 0;
        output.object = touches ? 1 : -1;
        std::array<SculptEntry, ToolPath::kMost> made;
        const size_t count = path.advance(tool, true, *bench.scene, bench.scene->restMotions,
                                          {.tick = ++tick, .dt = 1e-3, .hands = {}}, output, made);
        return std::vector<SculptEntry>(made.begin(), made.begin() + static_cast<ptrdiff_t>(count));
    };
    EXPECT_TRUE(at({0.0, 0.06, 0.0}, false).empty()) << "no contact";
    const std::vector<SculptEntry> first = at({0.0, 0.06, 0.0}, true);
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(first[1].color, kBlue);
    EXPECT_NEAR(first[1].centre.y, 0.4, 1e-12) << "at the proxy";
    for (int i = 0; i < 200; ++i)
        EXPECT_TRUE(at({0.0, 0.06, 0.0}, true).empty()) << "it rests";
    EXPECT_EQ(at({0.0021, 0.06, 0.0}, true).size(), 1u);
}

TEST(Painting, AJournalStatesTheColour) {
    const std::string point = R"("radius": 0.01, "points": [[0, 0, 0]])";
    const auto journal = [&](const std::string& members) {
        return sculptJournalOf(R"({"sculpt": 1, "strokes": [{)" + members + ", " + point + "}]}", "j");
    };
    const std::vector<SculptStep> steps = journal(R"("tool": "paint", "color": [0.5, 0, 1])");
    EXPECT_EQ(steps.at(0).color, glm::vec3(0.5f, 0.0f, 1.0f));
    EXPECT_EQ(sculptJournalOf(sculptJournalText(steps), "j"), steps);
    for (const char* broken :
         {R"("tool": "paint")", R"("tool": "paint", "color": [0.5, 0])",
          R"("tool": "paint", "color": [2, 0, 0])", R"("tool": "paint", "color": [0, 0, null])",
          R"("tool": "paint", "color": "red")", R"("tool": "carve", "color": [0.5, 0, 1])"})
        EXPECT_THROW((void)journal(broken), Error) << broken;
}

} // namespace
} // namespace touchstone::test::painting_test
