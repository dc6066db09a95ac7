// `touch --record` and `replay` as a user meets them.

#include "tests/support/program.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace touchstone::test::replay_tests {
namespace {

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kAssets = TOUCHSTONE_ASSETS;

class Replay : public testing::Test {
  protected:
    /// Touches a copy of a scene, so that a test may change it.
    void record(const std::string& asset, const std::vector<std::string>& more = {}) {
        std::filesystem::copy_file(kAssets + "/" + asset, scene_,
                                   std::filesystem::copy_options::overwrite_existing);
        writeTextFile(scratch_ / "hip.csv", straightPath({-0.05, 0.0, 0.09}, {0.05, 0.02, 0.0}, 1500));
        std::vector<std::string> arguments{kProgram,
                                           "touch",
                                           scene_.string(),
                                           "--path",
                                           (scratch_ / "hip.csv").string(),
                                           "--out",
                                           (scratch_ / "touched.csv").string(),
                                           "--record",
                                           file_.string(),
                                           "--fit",
                                           "workspace"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
    }
    ProgramResult replay(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{kProgram, "replay", file_.string(), "--json", json_.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::filesystem::remove(json_);
        return runProgram(arguments);
    }
    [[nodiscard]] nlohmann::json figures() const { return nlohmann::json::parse(readFile(json_)); }
    [[nodiscard]] static bool says(const std::string& text, const std::string& what) {
        return text.find(what) != std::string::npos;
    }

    ScratchFolder scratch_;
    std::filesystem::path scene_ = scratch_ / "scene.glb", file_ = scratch_ / "r.tsrec",
                          json_ = scratch_ / "r.json";
};

TEST_F(Replay, GivesTheSameTicksToTheLastDigit) {
    const std::vector<std::vector<std::string>> variants{{},
                                                         {"--closed-loop"},
                                                         {"--set", "contact=neighbourhood"},
                                                         {"--set", "friction=ho", "--rate", "2500"}};
    for (const char* asset : {"doughnut.glb", "moving.glb"})
        for (const std::vector<std::string>& variant : variants) {
            record(asset, variant);
            const std::string again = (scratch_ / "again.csv").string();
            const ProgramResult result = replay({"--out", again});
            ASSERT_EQ(result.status, 0) << result.out << result.err;
            EXPECT_TRUE(says(result.out, "replayed, all equal")) << result.out;
            EXPECT_EQ(result.err, "");
            EXPECT_EQ(withoutColumn(readFile(again), "step_ns"),
                      withoutColumn(readFile(scratch_ / "touched.csv"), "step_ns"));
            EXPECT_EQ(figures()["equal"], true);
            EXPECT_EQ(figures()["first_difference"], nullptr);
            EXPECT_EQ(figures()["recorded_by"]["same_build"], true);
            EXPECT_EQ(figures()["recorded_by"]["same_processor"], true);
            EXPECT_EQ(figures()["scenes"][0]["feels_the_same"], true);
            EXPECT_GT(figures()["contact"]["ticks"], 10);
        }
}

TEST_F(Replay, RecordingChangesNothing) {
    record("doughnut.glb");
    const std::string with = readFile(scratch_ / "touched.csv");
    ASSERT_EQ(runProgram({kProgram, "touch", scene_.string(), "--path", (scratch_ / "hip.csv").string(),
                          "--out", (scratch_ / "touched.csv").string(), "--fit", "workspace"})
                  .status,
              0);
    EXPECT_EQ(withoutColumn(readFile(scratch_ / "touched.csv"), "step_ns"), withoutColumn(with, "step_ns"));
}

TEST_F(Replay, ASceneThatFeelsOtherwiseIsSaidAndTheFirstTickNamed) {
    record("doughnut.glb");
    std::filesystem::copy_file(kAssets + "/torus_64800.glb", scene_,
                               std::filesystem::copy_options::overwrite_existing);
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(says(result.err, "has changed since it was touched: what is felt is not the same"))
        << result.err;
    EXPECT_TRUE(says(result.out, "differs first, in the stage '")) << result.out;
    EXPECT_EQ(figures()["equal"], false);
    EXPECT_GT(figures()["differing"], 0);
    EXPECT_TRUE(figures()["first_difference"]["stage"].is_string());
    EXPECT_EQ(figures()["scenes"][0]["same_file"], false);
    EXPECT_EQ(figures()["scenes"][0]["feels_the_same"], false);
}

TEST_F(Replay, ASceneThatOnlyLooksOtherwiseIsSaidToo) {
    record("doughnut.glb");
    // Another generator's name in the JSON, as long as ours: other bytes, the same model.
    std::string bytes = readFile(scene_);
    const size_t at = bytes.find("\"generator\":\"");
    ASSERT_NE(at, std::string::npos);
    bytes[at + 13] = bytes[at + 13] == 'X' ? 'Y' : 'X';
    writeTextFile(scene_, bytes);
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    EXPECT_TRUE(says(result.err, "has changed since it was touched, but nothing that is felt")) << result.err;
    EXPECT_EQ(figures()["scenes"][0]["same_file"], false);
    EXPECT_EQ(figures()["scenes"][0]["feels_the_same"], true);
}

TEST_F(Replay, ASceneThatIsGoneIsAskedForAndTakenFromElsewhere) {
    record("moving.glb");
    const std::filesystem::path moved = scratch_ / "elsewhere.glb";
    std::filesystem::rename(scene_, moved);
    const ProgramResult gone = replay();
    EXPECT_EQ(gone.status, 1);
    EXPECT_TRUE(says(gone.err, scene_.string() + ": the scene that was touched is not there")) << gone.err;
    EXPECT_TRUE(says(gone.err, "--scene")) << gone.err;
    EXPECT_FALSE(std::filesystem::exists(json_)) << "nothing half written";
    const ProgramResult found = replay({"--scene", moved.string()});
    EXPECT_EQ(found.status, 0) << found.out << found.err;
    // Recording and scene taken elsewhere together find each other.
    std::filesystem::create_directory(scratch_ / "other");
    std::filesystem::rename(moved, scratch_ / "other/scene.glb");
    std::filesystem::rename(file_, scratch_ / "other/r.tsrec");
    file_ = scratch_ / "other/r.tsrec";
    EXPECT_EQ(replay().status, 0);
}

TEST_F(Replay, AFileThatIsCutOffIsReplayedAsFarAsItGoes) {
    record("doughnut.glb");
    const std::string bytes = readFile(file_);
    writeTextFile(file_, bytes.substr(0, bytes.size() * 2 / 3));
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    EXPECT_TRUE(says(result.err, "is cut off")) << result.err;
    EXPECT_EQ(figures()["cut_off"], true);
    EXPECT_GT(figures()["replayed"], 500);
    EXPECT_LT(figures()["replayed"], 1500);
}

TEST_F(Replay, ADamagedFileIsNotTakenForAWholeOne) {
    record("doughnut.glb");
    std::string bytes = readFile(file_);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    writeTextFile(file_, bytes);
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(says(result.err, "spoilt as far as byte")) << result.err;
    EXPECT_EQ(figures()["equal"], true) << "what is left is equal";
    EXPECT_EQ(figures()["gaps"], 1);
    EXPECT_GT(figures()["replayed"], 100);
    EXPECT_LT(figures()["replayed"], figures()["ticks"]) << "there is no checkpoint behind the gap";
}

TEST_F(Replay, NothingToReplayIsNoSuccess) {
    record("doughnut.glb");
    const std::string bytes = readFile(file_);
    writeTextFile(file_, bytes.substr(0, 100)); // the header and half a chunk
    const ProgramResult empty = replay();
    EXPECT_EQ(empty.status, 1);
    EXPECT_TRUE(says(empty.out, "there are no ticks in it")) << empty.out;
    std::string spoilt = bytes;
    const size_t state = bytes.find("STAT");
    ASSERT_NE(state, std::string::npos);
    spoilt[state + 30] = static_cast<char>(spoilt[state + 30] ^ 1);
    writeTextFile(file_, spoilt);
    const ProgramResult headless = replay();
    EXPECT_EQ(headless.status, 1);
    EXPECT_TRUE(says(headless.out, "none of its ticks can be replayed")) << headless.out << headless.err;
    EXPECT_TRUE(says(headless.err, "spoilt")) << headless.err;
}

TEST_F(Replay, WhatIsNoRecordingSaysSo) {
    writeTextFile(file_, "t,x,y,z\n0,0,0,0\n");
    const ProgramResult text = replay();
    EXPECT_EQ(text.status, 1);
    EXPECT_TRUE(says(text.err, file_.string() + ": is no recording of Touchstone")) << text.err;
    file_ = scratch_ / "nothing";
    EXPECT_TRUE(says(replay().err, "No such file")) << replay().err;
    EXPECT_EQ(runProgram({kProgram, "replay"}).status, 2);
}

/// The oracle of a comparison: the same path touched with those settings.
TEST_F(Replay, AComparisonIsATouchWithTheOtherSettings) {
    const std::string changed = (scratch_ / "changed.csv").string(),
                      sides = (scratch_ / "sides.csv").string();
    for (const char* asset : {"doughnut.glb", "moving.glb"}) {
        record(asset);
        ASSERT_EQ(runProgram({kProgram, "touch", scene_.string(), "--path", (scratch_ / "hip.csv").string(),
                              "--out", changed, "--fit", "workspace", "--set", "friction=off", "--set",
                              "stiffness=300", "--set", "contact=neighbourhood"})
                      .status,
                  0);
        const ProgramResult result = replay(
            {"--compare", "friction=off, stiffness=300 contact=neighbourhood", "--compare-out", sides});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(says(result.out, "replayed, all equal")) << result.out;
        const Table then = readTable(scratch_ / "touched.csv"), now = readTable(changed),
                    both = readTable(sides);
        ASSERT_EQ(both.rows, then.rows);
        for (const char* name :
             {"proxy_x", "proxy_y", "proxy_z", "force_x", "force_y", "force_z", "contacts"}) {
            EXPECT_EQ(both[name], then[name]) << asset << name;
            EXPECT_EQ(both[std::string(name) + "_1"], now[name]) << asset << name;
        }
        const nlohmann::json first = figures()["compared"][0];
        EXPECT_EQ(first["settings"], "friction=off, stiffness=300 contact=neighbourhood");
        EXPECT_GT(first["max_difference_n"], 0.1) << first;
        EXPECT_GT(first["recorded"]["contact_ticks"], 10);
        EXPECT_LT(first["changed"]["mean_n"], first["recorded"]["mean_n"]) << "it is softer";
        EXPECT_TRUE(says(result.out, "contact=neighbourhood, over ")) << result.out;
    }
}

TEST_F(Replay, AComparisonWithTheSameSettingsFindsNoDifference) {
    record("doughnut.glb");
    ASSERT_EQ(replay({"--compare", "forceEnabled=on"}).status, 0);
    const nlohmann::json same = figures()["compared"][0];
    EXPECT_GT(same["ticks"], 10);
    EXPECT_EQ(same["max_difference_n"], 0.0);
    EXPECT_EQ(same["max_proxy_distance_m"], 0.0);
    EXPECT_EQ(same["recorded"], same["changed"]);
}

TEST_F(Replay, AComparisonBehindAGapLeavesOutWhatCannotBeTouched) {
    record("doughnut.glb");
    std::string bytes = readFile(file_);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    writeTextFile(file_, bytes);
    const std::string sides = (scratch_ / "sides.csv").string();
    const ProgramResult result = replay({"--compare", "friction=off", "--compare-out", sides});
    EXPECT_EQ(result.status, 1) << "it is damaged";
    EXPECT_EQ(readTable(sides).rows, figures()["replayed"]);
}

TEST_F(Replay, WrongComparisonsAreWrongUsage) {
    record("doughnut.glb");
    const std::string csv = (scratch_ / "sides.csv").string();
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--compare", "friction"},
                                               {"--compare", ""},
                                               {"--compare", " , "},
                                               {"--compare", "nosuch=1"},
                                               {"--compare", "friction=sandpaper"},
                                               {"--compare", "stiffness=-3"},
                                               {"--compare"},
                                               {"--compare-out", csv},
                                               {"--plot", "figure.pdf"}}) {
        const ProgramResult result = replay(wrong);
        EXPECT_EQ(result.status, 2) << wrong.back() << result.out << result.err;
        EXPECT_FALSE(std::filesystem::exists(csv));
    }
    const ProgramResult nowhere =
        replay({"--compare", "friction=off", "--compare-out", "/nowhere/sides.csv"});
    EXPECT_EQ(nowhere.status, 1);
    EXPECT_TRUE(says(nowhere.err, "/nowhere/sides.csv")) << nowhere.err;
    const ProgramResult undrawn = replay({"--plot", "/nowhere/figure.svg"});
    EXPECT_EQ(undrawn.status, 1);
    EXPECT_TRUE(says(undrawn.err, "/nowhere/figure")) << undrawn.err;
}

TEST_F(Replay, TheForceIsDrawnAsAFigure) {
    record("doughnut.glb");
    const std::filesystem::path svg = scratch_ / "figure.svg", png = scratch_ / "figure.png";
    ASSERT_EQ(replay({"--plot", svg.string(), "--compare", "friction=off"}).status, 0);
    const std::string drawn = readFile(svg);
    for (const char* text : {"as recorded", "friction=off", "force, N", "depth, mm", "time, s"})
        EXPECT_TRUE(says(drawn, text)) << text;
    ASSERT_EQ(replay({"--plot", png.string()}).status, 0);
    const std::string bytes = readFile(png);
    ASSERT_GT(bytes.size(), 10'000u);
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    const auto width = static_cast<unsigned char>(bytes[18]) * 256 + static_cast<unsigned char>(bytes[19]);
    EXPECT_EQ(width, 3 * 960) << "for print";
}

TEST_F(Replay, NothingThatIsReadOrWrittenIsOverwritten) {
    file_ = scratch_ / "r.dat"; // the name of the data beside a plot r.png
    record("box.glb");
    const std::string recorded = readFile(file_);
    const std::string scene = readFile(scene_), other = (scratch_ / "s.csv").string();
    std::filesystem::create_symlink(file_, scratch_ / "link.csv");
    const std::vector<std::vector<std::string>> refused{
        {"--plot", (scratch_ / "r.png").string()},
        {"--out", file_.string()},
        {"--out", (scratch_ / "link.csv").string()},
        {"--compare", "friction=off", "--compare-out", (scratch_ / "." / "r.dat").string()},
        {"--scene", scene_.string(), "--out", scene_.string()},
        {"--out", other, "--compare", "friction=off", "--compare-out", other}};
    for (const std::vector<std::string>& options : refused) {
        const ProgramResult result = replay(options);
        EXPECT_NE(result.status, 0) << options.back();
        EXPECT_TRUE(says(result.err, "overwritten")) << result.err;
        EXPECT_EQ(readFile(file_), recorded);
        EXPECT_EQ(readFile(scene_), scene);
    }
    EXPECT_FALSE(std::filesystem::exists(other));
}

/// A figure's name is nothing but a name to gnuplot.
TEST_F(Replay, AFigureMayHaveAnyName) {
    record("box.glb");
    std::filesystem::create_directories(scratch_ / "p");
    for (const std::string name :
         {"it's", "-e", "a'; system(\"touch PWN\"); b='", "# x", "< touch PWN;", "| touch PWN"}) {
        const std::filesystem::path file = scratch_ / "p" / (name + ".svg");
        const ProgramResult result = replay({"--plot", file.string()});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_TRUE(std::filesystem::exists(file)) << name;
        EXPECT_FALSE(std::filesystem::exists(scratch_ / "p" / "PWN"));
    }
    EXPECT_TRUE(
        says(replay({"--plot", (scratch_ / "p" / "two\nlines.svg").string()}).err, "control character"));
}

TEST_F(Replay, TouchSaysWhereItCannotRecord) {
    file_ = "/dev/full";
    writeTextFile(scratch_ / "hip.csv", straightPath({-0.05, 0.0, 0.09}, {0.05, 0.02, 0.0}, 1500));
    const ProgramResult result =
        runProgram({kProgram, "touch", kAssets + "/moving.glb", "--path", (scratch_ / "hip.csv").string(),
                    "--out", (scratch_ / "touched.csv").string(), "--record", "/dev/full"});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(says(result.err, "/dev/full: recording failed: No space left")) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "touched.csv")) << "nothing half written";
}

} // namespace
} // namespace touchstone::test::replay_tests
