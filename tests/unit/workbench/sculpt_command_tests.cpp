// `touchstone touch --sculpt`: what is sculpted is felt, saved, and the same every time.

#include "tests/support/program.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

namespace touchstone::test::sculpt_command_tests {
namespace {

std::string textOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A ball of 20 mm on 40^3 voxels of 1.5 mm about the origin, its axes the scene's.
class SculptCommand : public testing::Test {
  protected:
    SculptCommand() {
        std::filesystem::create_directories(folder_);
        std::ofstream file(folder_ / "clay.nrrd", std::ios::binary);
        file << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 40 40 40\nencoding: raw\n"
                "space: left-posterior-superior\nspace directions: (1.5,0,0) (0,0,1.5) (0,-1.5,0)\n"
                "space units: \"mm\" \"mm\" \"mm\"\nspace origin: (-29.25,29.25,-29.25)\n\n";
        for (int k = 0; k < 40; ++k)
            for (int j = 0; j < 40; ++j)
                for (int i = 0; i < 40; ++i) {
                    const double off = 1.5 * std::hypot(i - 19.5, j - 19.5, k - 19.5) - 20.0;
                    file.put(static_cast<char>(std::lround(std::clamp(128.0 - 8.0 * off, 0.0, 255.0))));
                }
        // Down onto the top, 2 mm deep.
        std::ofstream(folder_ / "path.csv") << straightPath({0, 0.03, 0}, {0, 0.018, 0}, 600);
    }
    ~SculptCommand() override { std::filesystem::remove_all(folder_); }

    void journal(const std::string& strokes) {
        std::ofstream(folder_ / "j.json") << R"({"sculpt": 1, "strokes": [)" << strokes << "]}";
    }
    ProgramResult touch(std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{TOUCHSTONE_BINARY,
                                           "touch",
                                           folder_ / "clay.nrrd",
                                           "--iso",
                                           "128",
                                           "--path",
                                           folder_ / "path.csv",
                                           "--out",
                                           folder_ / "ticks.csv",
                                           "--sculpt",
                                           folder_ / "j.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments);
    }
    const std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("sculpt_command_" + std::to_string(getpid()));
    const std::string top_ = R"({"tool": "carve", "radius": 0.008, "points": [[0, 0.02, 0]])";
};

TEST_F(SculptCommand, IsFeltAndSavedAndTheSameEveryTime) {
    journal(top_ + "}");
    std::string out, glb;
    for (int run = 0; run < 2; ++run) {
        const ProgramResult result = touch({"--sculpted", folder_ / "out.glb", "--sculpted",
                                            folder_ / "out.vdb", "--json", folder_ / "f.json"});
        ASSERT_EQ(result.status, 0) << result.err;
        // The hand stays above the hole's ground, 12 mm above the middle.
        const std::vector<double> contacts = readTable(folder_ / "ticks.csv")["contacts"];
        EXPECT_GT(contacts.size(), 0u);
        EXPECT_EQ(std::ranges::count(contacts, 0.0), static_cast<std::ptrdiff_t>(contacts.size()));
        if (run > 0) {
            EXPECT_EQ(result.out, out);
            EXPECT_EQ(textOf(folder_ / "out.glb"), glb);
        }
        out = result.out;
        glb = textOf(folder_ / "out.glb");
    }
    const auto figures = nlohmann::json::parse(textOf(folder_ / "f.json"));
    EXPECT_EQ(figures["sculpt"]["steps"], 1);
    // What two balls of 20 and 8 mm have in common, the smaller one's middle on the larger one's surface:
    // pi r^3 (2/3 - r / (4 R)).
    EXPECT_NEAR(figures["sculpt"]["removed_m3"].get<double>(),
                std::numbers::pi * std::pow(0.008, 3.0) * (2.0 / 3.0 - 0.1), 0.03 * 0.91e-6);
    // Both files are opened, and felt where the clay was sculpted: 12 mm above the middle.
    for (const char* saved : {"out.glb", "out.vdb"}) {
        std::ofstream(folder_ / "deep.csv") << straightPath({0, 0.03, 0}, {0, 0.010, 0}, 1000);
        const ProgramResult again = runProgram({TOUCHSTONE_BINARY, "touch", folder_ / saved, "--path",
                                                folder_ / "deep.csv", "--out", folder_ / "ticks.csv"});
        ASSERT_EQ(again.status, 0) << again.err;
        const Table table = readTable(folder_ / "ticks.csv");
        EXPECT_NEAR(table["proxy_y"].back(), 0.012, 0.00075) << saved; // half a voxel
        EXPECT_GT(table["contacts"].back(), 0.0);
    }
}

TEST_F(SculptCommand, AppliesStrokesAtTheirTimes) {
    // The hand has arrived at 0.5 s where the ball is 2 mm deep; the hole comes at 0.55 s.
    journal(top_ + R"(, "time": 0.55}, {"tool": "undo", "time": 60})");
    const ProgramResult result = touch({"--rate", "1000"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("1 strokes come after the last tick"), std::string::npos) << result.err;
    const Table table = readTable(folder_ / "ticks.csv");
    int felt = 0;
    for (size_t i = 0; i < table.rows; ++i) {
        EXPECT_TRUE(table["t"][i] < 0.55 || table["contacts"][i] == 0.0) << i;
        felt += table["contacts"][i] > 0.0 ? 1 : 0;
    }
    EXPECT_GT(felt, 20);
}

TEST_F(SculptCommand, RefusesWhatItCannotDo) {
    journal(top_ + "}");
    EXPECT_EQ(touch({"--sculpted", folder_ / "out.stl"}).status, 2);
    for (const char* broken : {"1", R"({"tool": "chisel"})",
                               R"({"tool": "carve", "radius": 0.01, "points": [[0, 0, 0]], "object": "no"})",
                               R"({"tool": "carve", "radius": 9, "points": [[0, 0, 0]]})"}) {
        journal(broken);
        const ProgramResult result = touch({"--sculpted", folder_ / "out.glb"});
        EXPECT_EQ(result.status, 1) << broken;
        EXPECT_NE(result.err.find("remedy"), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "ticks.csv"));
    }
    std::filesystem::remove(folder_ / "j.json");
    EXPECT_EQ(touch().status, 1);
    // Everything taken away has no mesh.
    journal(R"({"tool": "carve", "radius": 0.03, "points": [[0, 0, 0]]})");
    EXPECT_EQ(touch({"--sculpted", folder_ / "out.glb"}).status, 1);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.glb"));
    // A mesh is no field.
    journal(top_ + "}");
    const ProgramResult mesh =
        runProgram({TOUCHSTONE_BINARY, "touch", TOUCHSTONE_ASSETS "/box.glb", "--path", folder_ / "path.csv",
                    "--out", folder_ / "ticks.csv", "--sculpt", folder_ / "j.json"});
    EXPECT_EQ(mesh.status, 1);
    EXPECT_NE(mesh.err.find("implicit"), std::string::npos) << mesh.err;
}

/// Before touch begins and while it lasts, with an undo: the replay has the same fields, and a recording
/// whose journal has another stroke does not.
TEST_F(SculptCommand, ARecordingHoldsTheJournalAndReplaysToTheLastBit) {
    journal(R"({"tool": "add", "radius": 0.006, "points": [[0.01, 0.02, 0]]},)" + top_ +
            R"(, "time": 0.2}, {"tool": "undo", "time": 0.3},)"
            R"({"tool": "carve", "radius": 0.004, "points": [[0, 0.02, 0], [0.005, 0.02, 0]], "time": 0.4})");
    ASSERT_EQ(touch({"--record", folder_ / "r.tsrec"}).status, 0);
    const ProgramResult replay =
        runProgram({TOUCHSTONE_BINARY, "replay", folder_ / "r.tsrec", "--json", folder_ / "r.json"});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    const nlohmann::json figures = nlohmann::json::parse(textOf(folder_ / "r.json"));
    EXPECT_EQ(figures.at("equal"), true) << figures.dump(1);
    EXPECT_EQ(figures.at("replayed"), figures.at("ticks"));
}

/// Paint is seen, saved and replayed, and changes nothing that is felt.
TEST_F(SculptCommand, PaintsTheSurfaceAndLeavesTouchAsItIs) {
    journal("");
    ASSERT_EQ(touch().status, 0);
    const std::string plain = withoutColumn(textOf(folder_ / "ticks.csv"), "step_ns");
    journal(
        R"({"tool": "paint", "radius": 0.008, "color": [0.8, 0.1, 0], "points": [[0, 0.02, 0]]},)"
        R"({"tool": "paint", "radius": 0.004, "color": [0, 0, 1], "points": [[0, 0.02, 0]], "time": 0.3},)"
        R"({"tool": "undo", "time": 0.35}, {"tool": "redo", "time": 0.4})");
    ASSERT_EQ(touch({"--sculpted", folder_ / "out.glb", "--record", folder_ / "r.tsrec"}).status, 0);
    EXPECT_EQ(withoutColumn(textOf(folder_ / "ticks.csv"), "step_ns"), plain);
    EXPECT_NE(textOf(folder_ / "out.glb").find("COLOR_0"), std::string::npos);
    const ProgramResult replay =
        runProgram({TOUCHSTONE_BINARY, "replay", folder_ / "r.tsrec", "--json", folder_ / "r.json"});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    EXPECT_EQ(nlohmann::json::parse(textOf(folder_ / "r.json")).at("equal"), true);
    journal(R"({"tool": "paint", "radius": 0.008, "color": [0.8, 0.1, 3], "points": [[0, 0.02, 0]]})");
    EXPECT_EQ(touch().status, 1);
}

TEST_F(SculptCommand, RenderDrawsTheFieldInASlice) {
    const auto render = [&](const std::string& scene, std::vector<std::string> more) {
        std::vector<std::string> arguments{TOUCHSTONE_BINARY, "render", scene,  "--out",
                                           folder_ / "p.png", "--size", "64x64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments);
    };
    const std::string clay = folder_ / "clay.nrrd";
    const ProgramResult plain = render(clay, {"--iso", "128"});
    ASSERT_EQ(plain.status, 0) << plain.err;
    const std::string without = textOf(folder_ / "p.png");
    const ProgramResult sliced = render(clay, {"--iso", "128", "--slice", "x", "--slice-at", "0.4"});
    ASSERT_EQ(sliced.status, 0) << sliced.err;
    EXPECT_NE(sliced.out.find("field across x at"), std::string::npos) << sliced.out;
    EXPECT_NE(textOf(folder_ / "p.png"), without);
    EXPECT_EQ(render(TOUCHSTONE_ASSETS "/box.glb", {"--slice", "y"}).status, 1) << "a mesh has no field";
    EXPECT_EQ(render(clay, {"--slice", "w"}).status, 2);
    EXPECT_EQ(render(clay, {"--slice", "x", "--slice-at", "1.5"}).status, 2);
    EXPECT_EQ(render(clay, {"--slice-at", "0.5"}).status, 2);
}

/// The simulated hand sculpts in real time: what is saved lacks what was removed, and its recording replays.
TEST_F(SculptCommand, ARunSculptsWhatTheHandStrokes) {
    const ProgramResult run = runProgram({TOUCHSTONE_BINARY,
                                          "run",
                                          folder_ / "clay.nrrd",
                                          "--iso",
                                          "128",
                                          "--seconds",
                                          "2",
                                          "--stroke",
                                          "zigzag",
                                          "--size",
                                          "64x64",
                                          "--sculpt",
                                          "carve",
                                          "--sculpt-radius",
                                          "0.006",
                                          "--sculpted",
                                          folder_ / "out.glb",
                                          "--record",
                                          folder_ / "r.tsrec",
                                          "--json",
                                          folder_ / "f.json",
                                          "--flight-recorder",
                                          "off"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json sculpt = nlohmann::json::parse(textOf(folder_ / "f.json")).at("sculpt");
    EXPECT_GT(sculpt.at("dabs"), 0) << sculpt.dump(1);
    EXPECT_GT(sculpt.at("removed_m3"), 0.0);
    EXPECT_EQ(sculpt.at("dropped"), 0);
    EXPECT_GT(std::filesystem::file_size(folder_ / "out.glb"), 10000u);
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", folder_ / "r.tsrec"});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    EXPECT_EQ(runProgram({TOUCHSTONE_BINARY, "run", folder_ / "clay.nrrd", "--sculpt", "stamp",
                          "--sculpt-stamp", "nothing", "--seconds", "0.1"})
                  .status,
              1);
    EXPECT_EQ(runProgram({TOUCHSTONE_BINARY, "run", folder_ / "clay.nrrd", "--sculpt", "chisel"}).status, 2);
    EXPECT_EQ(runProgram({TOUCHSTONE_BINARY, "run", folder_ / "clay.nrrd", "--sculpt-radius", "0.01"}).status,
              2);
}

/// A program without the module that holds OpenVDB touches meshes, and says what a field needs.
TEST_F(SculptCommand, WithoutTheLibraryOfGridsAFieldIsRefusedByNameAndAMeshTouched) {
    const std::filesystem::path alone = folder_ / "touchstone";
    std::filesystem::copy_file(TOUCHSTONE_BINARY, alone);
    const auto touched = [&](const char* scene) {
        return runProgram({alone, "touch", std::string(TOUCHSTONE_ASSETS "/") + scene, "--path",
                           folder_ / "path.csv", "--out", folder_ / "ticks.csv"},
                          {"XDG_CACHE_HOME=" + (folder_ / "cache").string()});
    };
    const ProgramResult field = touched("field_torus.glb");
    EXPECT_EQ(field.status, 1);
    EXPECT_NE(field.err.find(
                  "touchstone_grids.so: the library of grids (distance fields, volumes) cannot be loaded"),
              std::string::npos)
        << field.err;
    EXPECT_NE(field.err.find("remedy: build touchstone_grids"), std::string::npos) << field.err;
    EXPECT_EQ(touched("torus_64800.glb").status, 0);
}

} // namespace
} // namespace touchstone::test::sculpt_command_tests
